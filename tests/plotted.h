/* The numbers that a script of a figure plots, by the names of their series, and numbers of a result by their path. */
#ifndef ROTID_TESTS_PLOTTED_H
#define ROTID_TESTS_PLOTTED_H

#include <cJSON.h>

#define PLOTTED_MOST 2000

/* The values of the series "objective [1]" in the data $block: how many; -1 where the script has no such block or series. NaN
 * stands for what is not drawn. */
int plotted(const char *script, const char *block, const char *series, double value[PLOTTED_MOST]);

/* The numbers at a path such as "base.modes[].error_percent" or "history[].x[0]", null being NaN: how many. The test fails where
 * a key is missing. */
int numbers_at(const cJSON *json, const char *path, double value[PLOTTED_MOST]);

#endif
