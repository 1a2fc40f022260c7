// SPDX-License-Identifier: GPL-2.0-or-later
// Values of a scene as text, and the reference of all keys.
#include "scene/keys.h"

#include "scene/materials.h"

#include <stdarg.h>
#include <stdlib.h>

// A growing line in a buffer of fixed size; what does not fit is cut.
typedef struct Line {
    char *text;
    int32_t size, used;
} Line;

static void add(Line *line, const char *format, ...) __attribute__((format(printf, 2, 3)));

// At most what is left of the buffer; `used` may then be beyond `size`, and nothing more is added.
static void add(Line *line, const char *format, ...)
{
    if (line->used >= line->size - 1) return;
    va_list arguments;
    va_start(arguments, format);
    line->used +=
        vsnprintf(line->text + line->used, (size_t)(line->size - line->used), format, arguments);
    va_end(arguments);
}

// As few digits as read back as the same number.
static void add_number(Line *line, double number)
{
    char text[40];
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) == number) break;
    }
    add(line, "%s", text);
}

// As YAML reads it back: quotes and backslashes escaped.
static void add_quoted(Line *line, const char *text)
{
    add(line, "\"");
    for (; *text; text++) add(line, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
    add(line, "\"");
}

// Each as it would stand in the file: `{nx: 80, shape: quad}`.
static void add_parameters(Line *line, const Scene *scene)
{
    add(line, "{");
    for (int32_t i = 0; i < scene->mesh.parameter_count; i++) {
        const MeshParameter *parameter = &scene->mesh.parameters[i];
        add(line, "%s%s: ", i ? ", " : "", parameter->name);
        if (*parameter->text)
            add(line, "%s", parameter->text);
        else
            add_number(line, parameter->value);
    }
    add(line, "}");
}

const char *scene_support_direction(const SceneSupport *support)
{
    if (support->x && support->z) return support->y ? "all" : "both";
    return support->x ? "x" : support->y ? "y" : "z";
}

static void add_tractions(Line *line, const Scene *scene)
{
    add(line, "[");
    for (int32_t i = 0; i < scene->load.traction_count; i++) {
        const SceneTraction *traction = &scene->load.tractions[i];
        add(line, "%s{group: %s, x: ", i ? ", " : "", traction->group);
        add_number(line, traction->x);
        if (traction->y != 0) {
            add(line, ", y: ");
            add_number(line, traction->y);
        }
        add(line, ", z: ");
        add_number(line, traction->z);
        add(line, "}");
    }
    add(line, "]");
}

static void add_supports(Line *line, const Scene *scene)
{
    add(line, "[");
    for (int32_t i = 0; i < scene->load.support_count; i++) {
        const SceneSupport *support = &scene->load.supports[i];
        add(line, "%s{group: %s, direction: %s}", i ? ", " : "", support->group,
            scene_support_direction(support));
    }
    add(line, "]");
}

static void add_numbers(Line *line, const SceneNumbers *numbers)
{
    add(line, "[");
    for (int32_t i = 0; i < numbers->count; i++) {
        if (i > 0) add(line, ", ");
        add_number(line, numbers->value[i]);
    }
    add(line, "]");
}

static void add_contact_laws(Line *line, const SceneContactLaws *laws)
{
    add(line, "[");
    for (int32_t i = 0; i < laws->count; i++) {
        const SceneContactLaw *item = &laws->item[i];
        const double numbers[] = {item->mu_static, item->mu_kinetic, item->critical_velocity};
        const bool given[] = {item->has_static, item->has_kinetic, item->has_critical};
        static const char *const words[] = {"mu_static", "mu_kinetic", "critical_velocity"};
        add(line, "%s{group: %s", i ? ", " : "", item->group);
        if (item->has_law) add(line, ", law: %s", friction_kind_name(item->kind));
        for (int32_t k = 0; k < 3; k++) {
            if (!given[k]) continue;
            add(line, ", %s: ", words[k]);
            add_number(line, numbers[k]);
        }
        if (*item->formula) add(line, ", formula: \"%s\"", item->formula);
        if (*item->along) add(line, ", along: \"%s\"", item->along);
        add(line, "}");
    }
    add(line, "]");
}

static void add_materials(Line *line, const SceneMaterials *materials)
{
    add(line, "{");
    for (int32_t i = 0; i < materials->count; i++) {
        const SceneMaterial *region = &materials->region[i];
        const char *between = "";
        add(line, "%s%s: {", i ? ", " : "", region->group);
        for (int32_t k = 0; k < SCENE_MATERIAL_NUMBERS; k++) {
            if (!region->given[k]) continue;
            add(line, "%s%s: ", between, scene_material_word(k));
            add_number(line, region->number[k]);
            between = ", ";
        }
        add(line, "}");
    }
    add(line, "}");
}

static void add_names(Line *line, const SceneNames *names)
{
    add(line, "[");
    for (int32_t i = 0; i < names->count; i++) add(line, "%s%s", i ? ", " : "", names->name[i]);
    add(line, "]");
}

// words is cut where it does not fit, as `amontons info` shows it.
void scene_key_value(const SceneKey *key, const Scene *scene, char *words, int32_t size)
{
    const void *field = (const char *)scene + key->offset;
    Line line = {.text = words, .size = size};
    words[0] = 0;
    switch (key->type) {
    case KEY_NUMBER:
        add_number(&line, *(const double *)field);
        return;
    case KEY_FLAG:
        add(&line, "%s", *(const bool *)field ? "true" : "false");
        return;
    case KEY_TEXT:
        add_quoted(&line, field);
        return;
    case KEY_NAME:
        add(&line, "%s", (const char *)field);
        return;
    case KEY_CHOICE:
        add(&line, "%s", key->choices[*(const int32_t *)field]);
        return;
    case KEY_NUMBERS:
        add_numbers(&line, field);
        return;
    case KEY_NAMES:
        add_names(&line, field);
        return;
    case KEY_PARAMETERS:
        add_parameters(&line, scene);
        return;
    case KEY_TRACTIONS:
        add_tractions(&line, scene);
        return;
    case KEY_SUPPORTS:
        add_supports(&line, scene);
        return;
    case KEY_CONTACT_LAWS:
        add_contact_laws(&line, field);
        return;
    case KEY_MATERIALS:
        add_materials(&line, field);
        return;
    case KEY_FIELDS:
        add(&line, "%s", scene->output.fields ? "as below" : "none");
        return;
    }
}

// The table of keys in docs/scenes.md; a test compares the two.
void scene_write_reference(FILE *out)
{
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    fprintf(out, "| key | default | allowed | dimension | meaning |\n"
                 "|---|---|---|---|---|\n");
    for (int32_t k = 0; k < count; k++) {
        char allowed[300];
        scene_key_allowed(&keys[k], allowed, sizeof allowed);
        fprintf(out, "| `%s` | ", keys[k].name);
        if (keys[k].may_lack)
            fprintf(out, "none");
        else if (!keys[k].standard)
            fprintf(out, "must be given");
        else
            fprintf(out, "`%s`%s", keys[k].standard,
                    keys[k].given_in_si ? "; with SI must be given" : "");
        bool is_number = keys[k].type == KEY_NUMBER || keys[k].type == KEY_NUMBERS;
        fprintf(out, " | %s | %s | %s |\n", allowed, is_number ? keys[k].unit : "",
                keys[k].sentence);
    }
}
