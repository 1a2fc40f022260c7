// SPDX-License-Identifier: GPL-2.0-or-later
// Words and scanner of gmsh 4 (4.8 to 4.15: its parser/Gmsh.l and Gmsh.y). gmsh skips what is not
// run (an If that is false, the body of a Macro) by looking for its last word without scanning what
// lies between; so no string may hold such a word, and no name may contain one. Then gmsh finds the
// same tokens in the text as were found here.
#include "io/mesh/geo_script.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/open_file.h"
#include "io/files/text_file.h"
#include "io/mesh/geo_parameters.h"

#include <ctype.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// STRING_MAX: gmsh ends a string after 1023 bytes, and takes the rest of it for statements.
// TOKENS_MAX: of 24 bytes each, which a file of brackets alone would have by the 100 million.
enum { STRING_MAX = 1000, WORD_SIZE = 64, TOKENS_MAX = 1 << 26 };

// --- the lists -----------------------------------------------------------------------------------

// Words that a script may use.
static const char ALLOWED[] =
    // order of statements
    "If ElseIf Else EndIf For In EndFor Macro Function Return Call Abort Exit "
    // numbers, lists and texts
    "Abs Acos ArcCos ArcSin ArcTan ArcTan2 Asin Atan Atan2 Ceil Cos Cosh Exp Fabs Floor Fmod Hypot "
    "Log Log10 Max Min Modulo Pi Rand Round Sin Sinh Sqrt Step Tan Tanh Catenary List LinSpace "
    "LogSpace Unique Find Exists GetForced GetForcedStr GetNumber GetString Append Cpu Memory "
    "TotalMemory Today MPI_Rank MPI_Size GMSH_MAJOR_VERSION GMSH_MINOR_VERSION GMSH_PATCH_VERSION "
    "Str StrCat StrChoice StrCmp StrFind StrLen StrPrefix StrRelative StrReplace StrSub Sprintf "
    "LowerCase LowerCaseIn UpperCase NameToString N2S Error Warning "
    "DefineConstant DefineNumber DefineString UndefineConstant SetNumber Struct NameStruct "
    "DimNameSpace "
    // what a parameter says of itself
    "Name Choices Label ReadOnly ReadOnlyRange Highlight Visible AutoCheck Closed Help Units Kind "
    "Range Loop Graph NumberFormat ChangedValue MultipleSelection Index Path Enum GmshOption "
    // geometry
    "newp newl newc newll newcl news newsl newv newf newreg SetFactory SetMaxTag SetTag Coherence "
    "Point Line Curve Circle Ellipse Ellipsis Ellipsoid Spline BSpline CatmullRom Bezier Nurbs "
    "Knots "
    "Order Wire Surface Plane Ruled Volume Rectangle Disk Box Block Sphere PolarSphere Cylinder "
    "Cone "
    "Torus Wedge ThruSections ThickSolid Fillet Chamfer Compound Euclidian Euclidean Parametric "
    "Coordinates Quadric Levelset Union Intersection Cut Crack CutMesh CutMeshTri SplitMesh "
    "MathEval "
    "Hole Sewing GeoEntity Affine Dilate Rotate Symmetry Translate "
    "Duplicata Extrude Layers Recombine RecombLaterals Recomblaterals QuadTriAddVerts "
    "QuadtriAddVerts QuadTriaddVerts QuadTriAddverts QuadTriNoNewVerts QuadTriNonewVerts "
    "QuadTriNoNewverts TransfQuadTri TransfquadTri TransfQuadtri Transfquadtri ScaleLastLayer "
    "Using "
    "Intersect Slide Split Reverse BooleanCoherence BooleanCommon BooleanCut BooleanDifference "
    "BooleanFragments BooleanFuse BooleanIntersection BooleanSection BooleanUnion HealShapes "
    "Boundary "
    "CombinedBoundary OrientedBoundary OrientedCombinedBoundary PointsOf BoundingBox Mass "
    "CenterOfMass MatrixOfInertia Closest Normal Curvature Parent Physical Delete Embedded "
    "Recursive "
    "Show Hide Model Meshes Physicals Variables All Empty Views SyncModel NewModel SetName "
    // meshes
    "Characteristic Length MeshSize MeshAlgorithm MeshSizeFromBoundary Smoother Transfinite Left "
    "Right Alternate AlternateLeft AlternateRight Progression Power Bump Beta Progression_HWall "
    "Bump_HWall Beta_HWall Beta_Symmetrical Beta_Symmetrical_HWall Periodic Degenerated Elliptic "
    "Field Background BoundaryLayer Mesh SetOrder OptimizeMesh PartitionMesh SetPartition "
    "RefineMesh "
    "RecombineMesh AdaptMesh RelocateMesh ReorientMesh ReverseMesh RenumberMeshNodes "
    "RenumberMeshElements CreateGeometry CreateTopology CreateMeshEdges CreateMeshFaces "
    "ClassifySurfaces TransformMesh Plugin Merge MergeWithBoundingBox ShapeFromFile SetChanged "
    // options of these two kinds
    "Geometry "
    // views, from which a field takes sizes
    "View SP VP TP SL VL TL ST VT TT SQ VQ TQ SS VS TS SH VH TH SI VI TI SY VY TY T2 T3 TIME "
    "INTERPOLATION_SCHEME TextAttributes";

// Statements that only show, write or wait, and options of the same kind: they are left out.
static const char LEFT_OUT[] =
    "Printf Print Save Draw Sleep Color General PostProcessing Solver View UnsplitWindow "
    "SetCurrentWindow SplitCurrentWindowHorizontal SplitCurrentWindowVertical Homology Cohomology "
    "Betti Combine Alias AliasWithOptions CopyOptions";

static const char FIELD_KINDS[] =
    "Attractor AttractorAnisoCurve AutomaticMeshSizeField Ball BoundaryLayer Box Centerline "
    "Constant "
    "Curvature Cylinder Distance Extend Frustum Gradient IntersectAniso Laplacian LonLat MathEval "
    "MathEvalAniso Max MaxEigenHessian Mean Min MinAniso Octree Param PostView Restrict Threshold";

// Plug-ins that change the mesh; others show or write, and are left out.
static const char PLUGINS[] = "Crack SimplePartition";

// Endings of files that gmsh itself reads for Merge, as they hold no statements.
static const char SHAPES[] = "step STEP stp STP brep brp BRP iges IGES igs IGS stl STL msh";

// Words of gmsh that reach out of the script: never a name of one's own.
static const struct {
    const char *words, *why;
} REFUSED[] = {
    {"System SystemCall NonBlockingSystemCall", "runs a command"},
    {"OnelabRun OnelabAction SendToServer ServerAction SetString TestLevel",
     "has to do with other programs"},
    {"CreateDir", "makes a folder"},
    {"GetEnv CurrentDirectory CurrentDir CurrentFileName AbsolutePath DirName FixRelativePath "
     "FileExists GmshExecutableName CodeName",
     "asks for what is on this computer"},
    {"ListFromFile FileName CommandLine", "opens a file or a program that was not looked at"},
    {"GetValue GetStringValue", "asks a question at the terminal"},
    {"S2N StringToName", "makes a name of a text, which could be any word"}};

// --- sets of words -------------------------------------------------------------------------------

typedef struct Word {
    const char *text;   // not zero-terminated
    int32_t length;
} Word;

typedef struct WordSet {
    Word *list;   // [count] sorted by word_order; owned
    int32_t count, room;
} WordSet;

static int word_order(const void *one, const void *other)
{
    const Word *a = one, *b = other;
    int32_t shorter = a->length < b->length ? a->length : b->length;
    int order = memcmp(a->text, b->text, (size_t)shorter);
    return order ? order : (a->length > b->length) - (a->length < b->length);
}

static bool word_add(WordSet *set, const char *text, int32_t length, Error *err)
{
    if (!memory_grow(&set->list, set->count, &set->room, sizeof *set->list, err)) return false;
    set->list[set->count++] = (Word){text, length};
    return true;
}

static void word_sort(WordSet *set)
{
    if (set->count) qsort(set->list, (size_t)set->count, sizeof *set->list, word_order);
}

static bool word_is_in(const WordSet *set, const char *text, int32_t length)
{
    Word word = {text, length};
    return set->count && bsearch(&word, set->list, (size_t)set->count, sizeof word, word_order);
}

// words: separated by single blanks, and kept by the caller.
static bool word_set(const char *words, WordSet *set, Error *err)
{
    for (const char *at = words; *at;) {
        int32_t length = (int32_t)strcspn(at, " ");
        if (!word_add(set, at, length, err)) return false;
        at += length + (at[length] == ' ');
    }
    word_sort(set);
    return true;
}

// Searches a list that is asked once a statement and not once a word.
static bool is_listed(const char *words, const char *text, int32_t length)
{
    for (const char *at = words; *at;) {
        int32_t size = (int32_t)strcspn(at, " ");
        if (size == length && memcmp(at, text, (size_t)size) == 0) return true;
        at += size + (at[size] == ' ');
    }
    return false;
}

// --- tokens --------------------------------------------------------------------------------------

typedef enum TokenKind { TOKEN_WORD, TOKEN_NUMBER, TOKEN_STRING, TOKEN_SIGN, TOKEN_END } TokenKind;

typedef struct Token {
    int32_t at, length;   // in `raw`; of a string with its quotes
    int32_t line;   // of raw, from 1
    int32_t behind;   // of a bracket that opens: index of the token behind its pair, or the end
    int32_t name_end;   // where what may stand behind a name ends that begins here (find_pairs)
    uint8_t kind;   // TokenKind
} Token;

typedef struct Reading {
    GeoScript *script;
    char *raw;   // [size] the files, one in the other, without comments; owned
    int32_t size, room;
    int32_t line;   // of raw, where it ends now
    Token *tokens;   // [token_count], a TOKEN_END behind them; owned
    int32_t token_count, token_room;
    int32_t depth;   // files open now
    WordSet allowed, left_out, own;   // own: names that the script gives a value
    char *out;   // [out_size] becomes the text; owned
    int32_t out_size, out_room;
} Reading;

static bool append(char **buffer, int32_t *size, int32_t *room, const char *bytes, int32_t count,
                   Error *err)
{
    int64_t needed = (int64_t)*size + count + 1;
    if (needed > GEO_BYTES_MAX)
        return REFUSE(err, "the .geo and what it includes are larger than %d MB",
                      GEO_BYTES_MAX >> 20);
    if (needed > *room) {
        int64_t more = needed > 2 * (int64_t)*room ? needed : 2 * (int64_t)*room;
        if (!memory_resize(buffer, *room, more, 1, err)) return false;
        *room = (int32_t)more;
    }
    memcpy(*buffer + *size, bytes, (size_t)count);
    *size += count;
    return true;
}

static bool put(Reading *reading, const char *bytes, int32_t count, Error *err)
{
    for (int32_t k = 0; k < count; k++) reading->line += bytes[k] == '\n';
    return append(&reading->raw, &reading->size, &reading->room, bytes, count, err);
}

static bool put_token(Reading *reading, TokenKind kind, const char *bytes, int32_t count,
                      Error *err)
{
    if (reading->token_count == TOKENS_MAX)
        return REFUSE(err, "the .geo and what it includes have more than %d words and signs",
                      TOKENS_MAX);
    if (!memory_grow(&reading->tokens, reading->token_count, &reading->token_room,
                     sizeof *reading->tokens, err))
        return false;
    reading->tokens[reading->token_count++] =
        (Token){.at = reading->size, .length = count, .line = reading->line, .kind = (uint8_t)kind};
    return put(reading, bytes, count, err);
}

static bool token_is(const Reading *reading, int32_t k, const char *text)
{
    if (k < 0 || k >= reading->token_count) return false;
    const Token *token = &reading->tokens[k];
    return (size_t)token->length == strlen(text) &&
           memcmp(reading->raw + token->at, text, (size_t)token->length) == 0;
}

static TokenKind token_kind(const Reading *reading, int32_t k)
{
    return k < 0 || k >= reading->token_count ? TOKEN_END : (TokenKind)reading->tokens[k].kind;
}

static bool put_place(Reading *reading, int32_t file, int32_t file_line, Error *err)
{
    GeoScript *script = reading->script;
    if (!memory_grow(&script->places, script->place_count, &script->place_room,
                     sizeof *script->places, err))
        return false;
    script->places[script->place_count++] = (GeoPlace){reading->line, file, file_line};
    return true;
}

void geo_script_place(const GeoScript *script, int32_t line, const char **path, int32_t *file_line)
{
    const GeoPlace *place = &script->places[0];
    for (int32_t k = 1; k < script->place_count && script->places[k].line <= line; k++)
        place = &script->places[k];
    *path = script->files[place->file];
    *file_line = place->file_line + line - place->line;
}

// The file, and its line, that a token comes from.
static void find_place(const Reading *reading, const Token *token, const char **path,
                       int32_t *file_line)
{
    geo_script_place(reading->script, token->line, path, file_line);
}

// Always fails, at token k.
static bool refuse_at(const Reading *reading, int32_t k, const char *why, Error *err)
{
    const Token *token = &reading->tokens[k];
    const char *path;
    int32_t file_line;
    find_place(reading, token, &path, &file_line);
    int shown = token->length < WORD_SIZE ? token->length : WORD_SIZE;
    return REFUSE(
        err,
        "%s:%d: `%.*s` %s; a .geo from elsewhere may only make geometry and a mesh. If you "
        "know where it comes from, give --trust (in Python trust=True), else mesh it with "
        "gmsh and name the .msh",
        path, file_line, shown, reading->raw + token->at, why);
}

// --- reading -------------------------------------------------------------------------------------

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// Length of the number that begins at `at`, by the rules of gmsh's scanner; 0: there is none.
static int32_t number_length(const char *at)
{
    int32_t digits = 0, length = 0;
    while (is_digit(at[length])) length++, digits++;
    if (at[length] == '.') {
        int32_t behind = length + 1;
        while (is_digit(at[behind])) behind++, digits++;
        if (digits) length = behind;
    }
    if (!digits) return 0;
    if (at[length] == 'e' || at[length] == 'E') {
        int32_t power = length + 1;
        if (at[power] == '+' || at[power] == '-') power++;
        if (is_digit(at[power])) {
            while (is_digit(at[power])) power++;
            length = power;
        }
    }
    return length;
}

// True where gmsh could take a part of the string or name for the end of what it skips: one of
// these words, with no letter behind it.
static bool holds_skip_word(const char *text, int32_t length)
{
    static const char *const words[] = {"EndIf", "ElseIf", "Else", "EndFor", "Return"};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        int32_t size = (int32_t)strlen(words[k]);
        for (int32_t i = 0; i + size <= length; i++)
            if (memcmp(text + i, words[k], (size_t)size) == 0 &&
                (i + size == length || !is_letter(text[i + size])))
                return true;
    }
    return false;
}

// Why a path must not stand between quotes in the text that gmsh is given; NULL: it may.
static const char *path_fault(const char *path)
{
    size_t length = strlen(path);
    if (strpbrk(path, "\"\n%\\")) return "has a quote or percent in its path";
    if (length > STRING_MAX) return "has a path that is longer than gmsh reads";
    if (holds_skip_word(path, (int32_t)length))
        return "has a word in its path that ends what gmsh skips";
    return NULL;
}

static bool read_file(Reading *reading, const char *path, Error *err);

static bool is_regular(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

// Goes by the last dot, as gmsh does.
static bool has_shape_ending(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && is_listed(SHAPES, dot + 1, (int32_t)strlen(dot + 1));
}

// The last three tokens, `Include "name";` or `Merge "name";`, become what is in the file. Shapes
// and meshes stay for gmsh to read. A missing file becomes an error of gmsh, should it come there.
static bool take_in(Reading *reading, const char *path, int32_t file, int32_t file_line, Error *err)
{
    const Token *name = &reading->tokens[reading->token_count - 2];
    int32_t begin = reading->tokens[reading->token_count - 3].at;
    char other[GEO_PATH_SIZE];
    bool merges = !token_is(reading, reading->token_count - 3, "Include");
    geo_included_path(path, reading->raw + name->at + 1, name->length - 2, other);
    if (merges && has_shape_ending(other)) return true;
    for (int32_t k = begin; k < reading->size; k++)
        if (reading->raw[k] != '\n') reading->raw[k] = ' ';
    reading->token_count -= 3;
    if (access(other, F_OK) != 0) {
        char missing[GEO_PATH_SIZE + 32];
        int length = snprintf(missing, sizeof missing, "Error(\"cannot open '%.800s'\");", other);
        return path_fault(other) ? REFUSE(err, "%s:%d: cannot open %s", path, file_line, other)
                                 : put(reading, missing, length, err);
    }
    if (!put(reading, "\n", 1, err)) return false;
    if (!read_file(reading, other, err)) {
        error_context(err, "included by %s", path);
        return false;
    }
    return put(reading, "\n", 1, err) && put_place(reading, file, file_line, err);
}

// The tokens of one text, the whole of file number `file`.
static bool scan(Reading *reading, const char *path, const char *text, int32_t file, Error *err)
{
    int32_t file_line = 1, length;
    for (const char *at = text; *at; at += length) {
        length = 1;
        if (at[0] == '/' && (at[1] == '/' || at[1] == '*')) {
            const char *end = at[1] == '/' ? strchr(at, '\n') : strstr(at + 2, "*/");
            if (!end && at[1] == '*')
                FAIL(err, ERROR_INPUT, "%s:%d: this comment has no end", path, file_line);
            length = !end ? (int32_t)strlen(at) : (int32_t)(end - at) + (at[1] == '*' ? 2 : 0);
            if (!put(reading, " ", 1, err)) goto cleanup;
            for (int32_t k = 0; k < length; k++) {
                file_line += at[k] == '\n';
                if (at[k] == '\n') TRY(put(reading, "\n", 1, err));
            }
        } else if (*at == '"' || *at == '\'') {
            const char *end = strchr(at + 1, *at);
            if (!end || end - at > STRING_MAX)
                FAIL(err, ERROR_INPUT, "%s:%d: this string %s", path, file_line,
                     end ? "is longer than gmsh reads" : "has no end");
            length = (int32_t)(end - at) + 1;
            TRY(put(reading, " ", 1, err));
            TRY(put_token(reading, TOKEN_STRING, at, length, err));
            if (holds_skip_word(at, length)) {
                refuse_at(reading, reading->token_count - 1,
                          "holds a word that ends what gmsh skips", err);
                goto cleanup;
            }
            for (int32_t k = 0; k < length; k++) file_line += at[k] == '\n';
        } else if (is_letter(*at)) {
            while (is_letter(at[length]) || is_digit(at[length])) length++;
            TRY(put_token(reading, TOKEN_WORD, at, length, err));
        } else if ((length = number_length(at)) > 0) {
            TRY(put_token(reading, TOKEN_NUMBER, at, length, err));
        } else if (isspace((unsigned char)*at)) {
            length = 1;
            file_line += *at == '\n';
            TRY(put(reading, *at == '\n' ? "\n" : " ", 1, err));
        } else {
            int32_t before = reading->token_count - 2;
            length = 1;
            TRY(put_token(reading, TOKEN_SIGN, at, 1, err));
            if (*at == ';' && token_kind(reading, before + 1) == TOKEN_STRING &&
                (token_is(reading, before, "Include") || token_is(reading, before, "Merge") ||
                 token_is(reading, before, "MergeWithBoundingBox")))
                TRY(take_in(reading, path, file, file_line, err));
        }
    }
cleanup:
    return error_is_clean(err);
}

static bool read_file(Reading *reading, const char *path, Error *err)
{
    GeoScript *script = reading->script;
    char *text = NULL;
    int32_t size = 0, file = script->file_count;
    reading->depth++;
    if (reading->depth > GEO_INCLUDE_DEPTH_MAX + 1)
        FAIL(err, ERROR_INPUT, "%s: files include each other more than %d deep", path,
             GEO_INCLUDE_DEPTH_MAX);
    if (file >= GEO_FILES_MAX)
        FAIL(err, ERROR_INPUT, "%s: more than %d files are included", path, GEO_FILES_MAX);
    // A pipe or terminal would never end.
    if (!is_regular(path)) FAIL(err, ERROR_INPUT, "%s: is no file", path);
    TRY(text_file_read(path, GEO_BYTES_MAX, &text, &size, err));
    if (strlen(text) != (size_t)size) FAIL(err, ERROR_INPUT, "%s: is no text", path);
    TRY(memory_grow(&script->files, file, &script->file_room, sizeof *script->files, err));
    TRY((script->files[file] = memory_text(path, err)));
    script->file_count++;
    TRY(put_place(reading, file, 1, err));
    TRY(scan(reading, path, text, file, err));
cleanup:
    reading->depth--;
    memory_free(text);
    return error_is_clean(err);
}

// --- what the script names itself ----------------------------------------------------------------

static bool is_open(const Reading *reading, int32_t k)
{
    return token_kind(reading, k) == TOKEN_SIGN &&
           strchr("([{", reading->raw[reading->tokens[k].at]);
}

static bool is_close(const Reading *reading, int32_t k)
{
    return token_kind(reading, k) == TOKEN_SIGN &&
           strchr(")]}", reading->raw[reading->tokens[k].at]);
}

// Index of the token behind the bracket that opens at token k and its pair; where there is none, at
// the end.
static int32_t behind_bracket(const Reading *reading, int32_t k)
{
    return is_open(reading, k) ? reading->tokens[k].behind : reading->token_count;
}

// Finds once for all tokens what would take a search from each of them: the pair of every bracket,
// and where indices and members behind a name end: x, x[0], x(), x~{i}, x.part.
static void find_pairs(Reading *reading)
{
    int32_t count = reading->token_count, top = -1;   // top: the last bracket that is still open
    Token *tokens = reading->tokens;
    for (int32_t k = 0; k < count; k++) {
        if (is_open(reading, k)) {
            tokens[k].behind = top;   // until its pair comes: the one that is open around it
            top = k;
        } else if (is_close(reading, k) && top >= 0) {
            int32_t around = tokens[top].behind;
            tokens[top].behind = k + 1;
            top = around;
        }
    }
    while (top >= 0) {
        int32_t around = tokens[top].behind;
        tokens[top].behind = count;
        top = around;
    }
    for (int32_t k = count - 1; k >= 0; k--) {
        int32_t next = k;   // where more may stand
        bool braces = token_is(reading, k, "{");
        if (token_is(reading, k, "~"))
            next = k + 1;
        else if (is_open(reading, k) && (!braces || token_is(reading, k - 1, "~")))
            next = tokens[k].behind;
        else if (token_is(reading, k, ".") && token_kind(reading, k + 1) == TOKEN_WORD)
            next = k + 2;
        tokens[k].name_end = next == k ? k : next < count ? tokens[next].name_end : count;
    }
}

// True where token k begins =, +=, -=, *=, /=, ++ or --, and not ==.
static bool is_assignment(const Reading *reading, int32_t k)
{
    if (token_kind(reading, k) != TOKEN_SIGN) return false;
    const char *at = reading->raw + reading->tokens[k].at;   // zero-terminated
    if (*at == '=') return at[1] != '=';
    return (strchr("+-*/", *at) && at[1] == '=') || (*at == '+' && at[1] == '+') ||
           (*at == '-' && at[1] == '-');
}

// Index of the token behind a name and its indices and members.
static int32_t behind_name(const Reading *reading, int32_t k)
{
    return k + 1 < reading->token_count ? reading->tokens[k + 1].name_end : reading->token_count;
}

static bool own_add(Reading *reading, int32_t k, Error *err)
{
    if (token_kind(reading, k) != TOKEN_WORD) return true;
    return word_add(&reading->own, reading->raw + reading->tokens[k].at, reading->tokens[k].length,
                    err);
}

// Whatever gets a value: by =, as a parameter, as a counter, as the name of a macro.
static bool find_own_names(Reading *reading, Error *err)
{
    for (int32_t k = 0; k < reading->token_count; k++) {
        if (token_kind(reading, k) != TOKEN_WORD) continue;
        if (token_is(reading, k, "For") || token_is(reading, k, "Macro") ||
            token_is(reading, k, "Function") || token_is(reading, k, "Struct"))
            TRY(own_add(reading, k + 1, err));
        if ((token_is(reading, k, "DefineConstant") || token_is(reading, k, "UndefineConstant") ||
             token_is(reading, k, "DefineNumber") || token_is(reading, k, "DefineString")) &&
            is_open(reading, k + 1)) {
            // Past brackets within: each token is looked at once, however deep they are.
            int32_t end = behind_bracket(reading, k + 1);
            TRY(own_add(reading, k + 2, err));
            for (int32_t i = k + 2; i < end;
                 i = is_open(reading, i) ? reading->tokens[i].behind : i + 1)
                if (token_is(reading, i, ",")) TRY(own_add(reading, i + 1, err));
        }
        int32_t behind = k + 1;
        if (!is_assignment(reading, behind) &&
            (is_open(reading, behind) || token_is(reading, behind, "~") ||
             token_is(reading, behind, ".")))
            behind = behind_name(reading, k);
        if (is_assignment(reading, behind)) TRY(own_add(reading, k, err));
    }
    word_sort(&reading->own);
cleanup:
    return error_is_clean(err);
}

// --- judging -------------------------------------------------------------------------------------

// Appends raw from *from to `to`, which *from becomes; blank: its lines alone.
static bool copy_to(Reading *reading, int32_t *from, int32_t to, bool blank, Error *err)
{
    int32_t begin = reading->out_size;
    bool done = append(&reading->out, &reading->out_size, &reading->out_room, reading->raw + *from,
                       to - *from, err);
    for (int32_t i = begin; blank && i < reading->out_size; i++)
        if (reading->out[i] != '\n') reading->out[i] = ' ';
    *from = to;
    return done;
}

static bool say(Reading *reading, const char *words, Error *err)
{
    return append(&reading->out, &reading->out_size, &reading->out_room, words,
                  (int32_t)strlen(words), err);
}

// The token behind the statement that begins at k: behind its `;`, or where `block`, behind its {}.
// -1: it has no end, or holds a word that orders statements.
static int32_t behind_statement(const Reading *reading, int32_t k, bool block)
{
    int32_t depth = 0;
    for (int32_t i = k; i < reading->token_count; i++) {
        if (i > k && is_listed("If ElseIf Else EndIf For EndFor Macro Function Return Abort Exit",
                               reading->raw + reading->tokens[i].at, reading->tokens[i].length))
            return -1;
        if (is_open(reading, i)) depth++;
        if (is_close(reading, i) && --depth <= 0 && block && token_is(reading, i, "}"))
            return i + 1;
        if (token_is(reading, i, ";") && depth <= 0) return i + 1;
    }
    return -1;
}

// Puts the working folder before a relative path, and changes nothing else of it. false: there is
// no room.
static bool make_absolute(char path[GEO_PATH_SIZE])
{
    char folder[PATH_MAX], whole[GEO_PATH_SIZE];
    if (path[0] == '/') return true;
    if (!getcwd(folder, sizeof folder)) return false;
    if (snprintf(whole, sizeof whole, "%s/%s", folder, path) >= (int)sizeof whole) return false;
    strcpy(path, whole);
    return true;
}

// `Merge "part.step";` with the path that it means in this file; the name alone would be looked for
// beside the text that gmsh reads. *from is behind it then.
//
// gmsh goes by the ending of the path that it is given, and by what stands beside it: so it is
// given the very path that is checked here. A link is left for it to follow. The path that the link
// leads to may end otherwise, and is nowhere used.
static bool merge(Reading *reading, int32_t k, int32_t *from, Error *err)
{
    char other[GEO_PATH_SIZE], words[GEO_PATH_SIZE + 8], begin[16] = "";
    const Token *name = &reading->tokens[k + 1];
    const char *path;
    int32_t file_line;
    if (token_kind(reading, k + 1) != TOKEN_STRING || !token_is(reading, k + 2, ";"))
        return refuse_at(reading, k, "opens a file whose name is not written out", err);
    find_place(reading, name, &path, &file_line);
    geo_included_path(path, reading->raw + name->at + 1, name->length - 2, other);
    if (!make_absolute(other)) return refuse_at(reading, k + 1, "has too long a path", err);

    // The file is one that gmsh reads itself: it holds no statements, and has none beside it.
    const char *dot = strrchr(other, '.'), *fault = path_fault(other);
    bool is_there = access(other, F_OK) == 0;
    if (fault) return refuse_at(reading, k + 1, fault, err);
    if (!has_shape_ending(other)) return refuse_at(reading, k + 1, "is no shape or mesh", err);
    if (is_there && !is_regular(other)) return refuse_at(reading, k + 1, "is no file", err);
    snprintf(words, sizeof words, "%s.opt", other);
    if (open_is_there(words))
        return refuse_at(reading, k + 1, "has options beside it (.opt), which gmsh would read",
                         err);
    if (is_there && strcmp(dot, ".msh") == 0) {
        int file = open(other, O_RDONLY | O_CLOEXEC);
        ssize_t count = file < 0 ? 0 : read(file, begin, sizeof begin - 1);
        if (file >= 0) close(file);
        if (count <= 0 || strncmp(begin, "$MeshFormat", strlen("$MeshFormat")) != 0)
            return refuse_at(reading, k + 1, "is no mesh", err);
    }
    snprintf(words, sizeof words, "\"%s\"", other);
    return copy_to(reading, from, name->at, false, err) && say(reading, words, err) &&
           (*from = name->at + name->length) > 0;
}

// `ShapeFromFile(file)`: the path, which may be any text, is relative to the folder of this file.
static bool shape(Reading *reading, int32_t k, int32_t *from, Error *err)
{
    char folder[GEO_PATH_SIZE];   // with a slash at its end
    const char *path, *fault;
    int32_t file_line, end = behind_bracket(reading, k + 1);
    if (!token_is(reading, k + 1, "(") || end - k < 4 || !is_close(reading, end - 1))
        return refuse_at(reading, k, "is not followed by (a name)", err);
    find_place(reading, &reading->tokens[k], &path, &file_line);
    geo_included_path(path, "", 0, folder);
    fault = make_absolute(folder) ? path_fault(folder) : "stands in a file with too long a path";
    if (fault) return refuse_at(reading, k, fault, err);
    int32_t begin = reading->tokens[k + 2].at;
    int32_t behind = reading->tokens[end - 1].at;
    const char *parts[] = {"StrChoice(StrCmp(StrSub(",
                           NULL,
                           ", 0, 1), \"/\"), StrCat(\"",
                           folder,
                           "\", ",
                           NULL,
                           "), ",
                           NULL,
                           ")"};
    for (int32_t i = begin; i < behind; i++)
        if (reading->raw[i] == '\n')
            return refuse_at(reading, k, "is written over several lines", err);
    if (!copy_to(reading, from, begin, false, err)) return false;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        if (!(parts[i] ? say(reading, parts[i], err)
                       : append(&reading->out, &reading->out_size, &reading->out_room,
                                reading->raw + begin, behind - begin, err)))
            return false;
    *from = behind;
    return true;
}

// Statements that are left out begin at k; the token behind them, or k: none does. -1: an error.
static int32_t left_out(const Reading *reading, int32_t k, Error *err)
{
    const Token *token = &reading->tokens[k];
    const char *text = reading->raw + token->at;
    bool is_member = token_is(reading, k - 1, ".");
    bool is_view = token_is(reading, k, "View"), is_plugin = token_is(reading, k, "Plugin");
    bool is_option = is_listed("General PostProcessing Solver View Print", text, token->length);
    // Mesh.Color.Lines, Geometry.DoubleClickedPointCommand: for the screen.
    bool for_screen = (token_is(reading, k, "Geometry") || token_is(reading, k, "Mesh")) &&
                      token_is(reading, k + 1, ".") && token_kind(reading, k + 2) == TOKEN_WORD &&
                      (token_is(reading, k + 2, "Color") ||
                       memmem(reading->raw + reading->tokens[k + 2].at,
                              (size_t)reading->tokens[k + 2].length, "Command", 7));
    if (is_member) return k;
    if (is_view && !token_is(reading, k + 1, "[") && !token_is(reading, k + 1, ".")) return k;
    if (is_plugin && token_kind(reading, k + 2) == TOKEN_WORD &&
        is_listed(PLUGINS, reading->raw + reading->tokens[k + 2].at, reading->tokens[k + 2].length))
        return k;
    if (!for_screen && !is_plugin && !word_is_in(&reading->left_out, text, token->length)) return k;

    // A statement may begin here.
    bool begins = k == 0;
    if (k > 0) {
        const Token *before = &reading->tokens[k - 1];
        const char *at = reading->raw + before->at;
        if (before->kind == TOKEN_SIGN)
            begins = strchr(";})", *at) != NULL;
        else if (before->kind == TOKEN_WORD)
            begins = is_listed("Else EndIf EndFor Return Recursive", at, before->length) ||
                     token_is(reading, k - 2, "Macro") || token_is(reading, k - 2, "Function");
        else
            begins = before->kind == TOKEN_STRING && token_is(reading, k - 2, "Macro");
    }
    if (begins) {
        int32_t behind = behind_statement(reading, k, token_is(reading, k, "Color"));
        if (behind < 0) refuse_at(reading, k, "begins a statement that has no end", err);
        return behind;
    }
    // Read in an expression, or `Background Mesh View[0]`.
    if (is_option && !is_assignment(reading, behind_name(reading, k))) return k;
    refuse_at(reading, k, "shows or writes something, in a place where it cannot be left out", err);
    return -1;
}

static bool check_word(Reading *reading, int32_t k, Error *err)
{
    const Token *token = &reading->tokens[k];
    const char *text = reading->raw + token->at;
    bool is_member = token_is(reading, k - 1, ".");
    // Its own name, which cannot be given: left_out.
    if (is_member && token_is(reading, k, "FileName") && token_is(reading, k - 2, "General"))
        return true;
    for (size_t i = 0; i < sizeof REFUSED / sizeof REFUSED[0]; i++)
        if (is_listed(REFUSED[i].words, text, token->length))
            return refuse_at(reading, k, REFUSED[i].why, err);
    if (token_is(reading, k, "Include"))
        return refuse_at(reading, k, "includes a file whose name is not written out", err);

    // `Field[1] = Box`, `Field[1].VIn = 3`, `Background Field = 1`.
    if (token_is(reading, k, "Field") && !is_member) {
        if (is_assignment(reading, k + 1) || !is_open(reading, k + 1)) return true;
        int32_t behind = behind_bracket(reading, k + 1);
        if (!token_is(reading, behind, "=") || behind + 1 >= reading->token_count) return true;
        const Token *kind = &reading->tokens[behind + 1];
        if (kind->kind == TOKEN_WORD &&
            is_listed(FIELD_KINDS, reading->raw + kind->at, kind->length))
            return true;
        return refuse_at(reading, behind + 1, "is no kind of field that is allowed", err);
    }

    // A name that the script gives a value must not be used as a command.
    bool is_allowed = word_is_in(&reading->allowed, text, token->length);
    if (is_allowed && !is_member) return true;
    if (is_member || word_is_in(&reading->own, text, token->length)) {
        TokenKind next = token_kind(reading, k + 1);
        if (holds_skip_word(text, token->length))
            return refuse_at(reading, k, "has a word in it that ends what gmsh skips", err);
        if (next == TOKEN_SIGN || next == TOKEN_END || token_is(reading, k + 1, "In") ||
            token_is(reading, k + 1, "Using") || token_is(reading, k - 1, "Macro") ||
            token_is(reading, k - 1, "Function"))
            return true;
        return refuse_at(reading, k, "is no command of gmsh's that is allowed", err);
    }
    // A kind of field, behind Field[1] =.
    if (is_listed("General PostProcessing Solver Print", text, token->length)) return true;
    if (token_is(reading, k - 1, "=") && is_listed(FIELD_KINDS, text, token->length)) return true;
    if (token_is(reading, k - 1, "(") && token_is(reading, k - 2, "Plugin")) return true;
    return refuse_at(reading, k,
                     "is neither a word of gmsh's that is allowed nor given a value in the file",
                     err);
}

static bool judge(Reading *reading, Error *err)
{
    int32_t from = 0;
    for (int32_t k = 0; k < reading->token_count; k++) {
        if (token_kind(reading, k) != TOKEN_WORD) continue;
        int32_t behind = left_out(reading, k, err);
        if (behind < 0) return false;
        bool leaves = token_is(reading, k, "Exit") && !token_is(reading, k - 1, ".");
        bool opens = token_is(reading, k, "Merge") || token_is(reading, k, "MergeWithBoundingBox");
        bool is_shape = token_is(reading, k, "ShapeFromFile");
        // The argument of ShapeFromFile is in the text already: nothing of it can be changed.
        if (reading->tokens[k].at < from && (behind > k || leaves || opens || is_shape))
            return refuse_at(reading, k, "stands inside the brackets of ShapeFromFile", err);
        if (leaves) behind = behind_statement(reading, k, false);
        if (leaves && behind < 0)
            return refuse_at(reading, k, "begins a statement that has no end", err);
        if (behind > k) {
            // gmsh would end this process at Exit; Abort ends the script.
            int32_t end = reading->tokens[behind - 1].at + 1;
            if (!copy_to(reading, &from, reading->tokens[k].at, false, err) ||
                (leaves && !say(reading, "Abort; ", err)) ||
                !copy_to(reading, &from, end, true, err))
                return false;
            k = behind - 1;
            continue;
        }
        if (!check_word(reading, k, err)) return false;
        if (opens && !merge(reading, k, &from, err)) return false;
        if (is_shape && !shape(reading, k, &from, err)) return false;
    }
    return copy_to(reading, &from, reading->size, false, err);
}

bool geo_script_read(const char *path, GeoScript *script, Error *err)
{
    Reading reading = {.script = script, .line = 1};
    *script = (GeoScript){0};
    TRY(word_set(ALLOWED, &reading.allowed, err));
    TRY(word_set(LEFT_OUT, &reading.left_out, err));
    TRY(read_file(&reading, path, err));
    TRY(put(&reading, "\n", 1, err));
    find_pairs(&reading);
    TRY(find_own_names(&reading, err));
    TRY(judge(&reading, err));
    script->text = reading.out;
    script->size = reading.out_size;
    reading.out = NULL;
cleanup:
    memory_free_all(reading.raw, reading.tokens, reading.allowed.list, reading.left_out.list,
                    reading.own.list, reading.out);
    return error_is_clean(err);
}

void geo_script_destroy(GeoScript *script)
{
    for (int32_t k = 0; k < script->file_count; k++) memory_free(script->files[k]);
    memory_free_all(script->text, script->files, script->places);
    *script = (GeoScript){0};
}
