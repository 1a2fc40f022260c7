// SPDX-License-Identifier: GPL-2.0-or-later
// Fields of the block for a film, between two times that were stored. The run of a result is
// computed once more, and fields are kept each time the rod, or the fastest point of the contact,
// has moved on by as little as from one frame of the film to the next. Called by run/result/film.
#ifndef AMONTONS_RUN_RESULT_FILM_FIELDS_H
#define AMONTONS_RUN_RESULT_FILM_FIELDS_H

#include "amontons.h"

typedef struct FilmFields {
    char folder[AMONTONS_PATH_SIZE];   // of the second result, inside of the first; empty: none
} FilmFields;

// ERROR_INPUT: no scene is in the result, or its run does not come out as the stored one.
bool film_fields_make(const char *folder, const FilmRequest *request, FilmFields *fields,
                      Error *err);
void film_fields_remove(FilmFields *fields);   // with all that is in it; zeroed is fine

#endif
