// SPDX-License-Identifier: GPL-2.0-or-later
// amontons_report: which page the results want, and the page as a file.
#include "page/page.h"

#include "base/child_process.h"
#include "base/decimal_point.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "io/files/part_file.h"
#include "render/picture_options.h"
#include "run/result/pictures.h"

#include <unistd.h>

enum { SECONDS_MAX = 600 };   // far above what the longest history takes

typedef struct ReportRequest {
    const char *const *results;   // [count]
    int32_t count;
    const char *file;
    PictureStyle style;
} ReportRequest;

static bool write_file(void *context, FILE *reply, Error *err)
{
    const ReportRequest *request = context;
    TextWriter *html = NULL;

    // All that a page reads of a folder; the figures of a sweep are looked at one by one.
    static const char *const read[] = {
        "sweep.csv",  "sweep.h5",         "ranking.csv", "answer.txt",
        "figures",    "figures/best.png", "run.json",    "figures/accuracy.json",
        "history.h5", "history.h5.part",  "fields.pvd",  "fields"};
    int32_t count = request->count;
    (void)reply;   // the page is a file
    for (int32_t k = 0; k < count; ++k) {
        const char *folder = request->results[k];
        TRY(pictures_check_folder(folder, err));
        for (size_t i = 0; i < sizeof read / sizeof *read; ++i)
            TRY(folder_check_inside(folder, read[i], err));
        if (count > 1 && folder_holds(folder, "sweep.csv", NULL))
            FAIL(err, ERROR_INPUT,
                 "%s is a sweep: only runs are compared; a sweep has its own page", folder);
    }
    bool sweep = count == 1 && folder_holds(request->results[0], "sweep.csv", NULL);
    if (request->style.cycle && (sweep || count > 1))
        FAIL(err, ERROR_INPUT, "a cycle has a meaning for the page of one run alone");
    TRY(html = text_writer_create(request->file, request->style.overwrite, err));
    if (count > 1)
        TRY(compare_page_write(html, request->results, count, err));
    else if (sweep)
        TRY(sweep_page_write(html, request->results[0], err));
    else
        TRY(run_page_write(html, request->results[0], request->style.cycle, err));
cleanup:
    return text_writer_finish(html, err);
}

// A stranger's history may crash HDF5, or keep it busy for ever.
bool amontons_report(const char *const *results, int32_t count, const char *file,
                     const PictureStyle *style, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    ReportRequest request = {results, count, file, style ? *style : (PictureStyle){0}};
    ChildWork work = {.path = count > 0 ? results[0] : "",
                      .reader = "HDF5 or VTK",
                      .seconds = SECONDS_MAX,
                      .advice = "its history is damaged",
                      .read = write_file,
                      .context = &request};
    char part[PATH_MAX + 8];
    bool left = part_file_name(file, part) && open_is_there(part);   // by whom, is not known
    if (count < 1) FAIL(err, ERROR_INPUT, "a report needs a result folder");
    TRY(picture_options_fit_taker(&request.style, TAKEN_BY_PAGES, err));
    TRY(child_do(&work, err));
cleanup:
    // A process that crashed leaves what it began.
    if (!error_is_clean(err) && !left && part_file_name(file, part)) unlink(part);
    return error_is_clean(err);
}
