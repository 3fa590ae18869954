/* Plans, decks and files of results in a folder of a test's own, and runs of rotid study on them. */
#ifndef ROTID_TESTS_STUDY_BENCH_H
#define ROTID_TESTS_STUDY_BENCH_H

#include <cJSON.h>
#include <sys/types.h>

#include "study/study.h"

/* Three cylinders of steel with six measured modes near those of the model and twelve sensors; E of the core and of the left end
 * are identified. A run takes a few milliseconds. */
#define BENCH_BEAM                                                                                                               \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"                                                             \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0, 6\n*SHAFT, NAME=core, MATERIAL=steel\n0.4, 0.1, 0, 8\n"                    \
    "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.06, 0, 6\n"
#define BENCH_MODES   "*MODES\n1, 398.9\n2, 713.5\n3, 1722\n4, 2480\n5, 3970\n6, 5020\n"
#define BENCH_SENSORS "*SENSORS\n1, 0\n2, 0.1\n3, 0.2\n4, 0.3\n5, 0.4\n6, 0.5\n7, 0.6\n8, 0.7\n9, 0.8\n10, 0.85\n11, 0.9\n12, 1\n"
#define BENCH_WANTED  "*IDENTIFY\ncore.E, 1e10, 1e12, 2e11\nleft.E, 1e10, 1e12, 2e11\n"
#define BENCH_DECK    BENCH_BEAM BENCH_MODES BENCH_SENSORS BENCH_WANTED

extern char bench_folder[];

/* The folder with deck.inp (BENCH_DECK) in it, as setup and teardown of a group of cmocka. */
int bench_make(void **state);
int bench_remove(void **state);

const char *bench_path(const char *name);
/* The path of a new file with that text. */
const char *bench_write(const char *name, const char *text);
/* To be freed; NULL where there is none. */
char *bench_read(const char *name);
void bench_delete(const char *name);

struct bench_outcome {
    int code;       /* 128 + signal where a signal ended it */
    char out[8192]; /* both streams */
};

/* Starts rotid in the folder with arguments separated by blanks, of which '%' becomes a blank; output goes to the file "said". */
pid_t bench_start(const char *arguments);
struct bench_outcome bench_wait(pid_t process);
struct bench_outcome bench_run(const char *arguments);
/* Asserts the exit code and a part of what is said. */
void bench_says(const char *arguments, int code, const char *text);

/* Processes that this one has started, up to `most`. */
int bench_children(pid_t process, int most, pid_t *child);
/* Whether a process ends within that time, whoever has to take note of that. */
int bench_ends(pid_t process, double seconds);

/* Lines of a file of results. */
int bench_lines(const char *name);
/* Whether two files of results are the same but for the times. */
int bench_same(const char *a, const char *b);

/* The study of a plan of that text, which is written to "plan.txt". Status of plan_read or study_open; messages in the list. */
int bench_study(struct pool *pool, const char *text, struct message_list *messages, struct study *study);
/* The result of a run, to be deleted. */
cJSON *bench_result(const struct study *study, long run);
/* Member `key` of element i of the array `list`. */
double bench_number(const cJSON *result, const char *list, int i, const char *key);
/* What parameter p is in truth. */
double bench_truth(const cJSON *result, int p);

#endif
