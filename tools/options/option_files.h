/* What the table of options gives for the completions of the shells and for docs/rotid.1. */
#ifndef ROTID_TOOLS_OPTIONS_OPTION_FILES_H
#define ROTID_TOOLS_OPTIONS_OPTION_FILES_H

#include <stdio.h>

struct option_file {
    const char *path, *begin, *end; /* below the source; lines between which the file is generated */
    void (*write)(FILE *out);
};

/* Ended by one without a path. */
extern const struct option_file option_files[];

/* The text of a file with what stands between its marks anew: to free; NULL where a mark is missing or there is no memory. */
char *option_file_text(const struct option_file *file, const char *text);

#endif
