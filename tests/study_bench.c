#include "study_bench.h"

#include <dirent.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "json_value.h"
#include "result/result.h"
#include "study/study.h"
#include "support.h"

extern char **environ;

char bench_folder[] = "/tmp/test_study_XXXXXX";

int bench_make(void **state)
{
    (void)state;
    if (!mkdtemp(bench_folder))
        return 1;
    (void)bench_write("deck.inp", BENCH_DECK);
    return 0;
}

int bench_remove(void **state)
{
    (void)state;
    DIR *stream = opendir(bench_folder);
    for (struct dirent *entry; stream && (entry = readdir(stream));)
        if (entry->d_name[0] != '.')
            (void)unlink(bench_path(entry->d_name));
    if (stream)
        (void)closedir(stream);
    return rmdir(bench_folder);
}

const char *bench_path(const char *name)
{
    static char path[16][512];
    static int next;
    next = (next + 1) % 16;
    (void)snprintf(path[next], sizeof path[next], "%s/%s", bench_folder, name);
    return path[next];
}

const char *bench_write(const char *name, const char *text)
{
    const char *path = bench_path(name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
    return path;
}

char *bench_read(const char *name)
{
    FILE *stream = fopen(bench_path(name), "rb");
    if (!stream)
        return NULL;
    assert_int_equal(fseek(stream, 0, SEEK_END), 0);
    size_t length = (size_t)ftell(stream);
    rewind(stream);
    char *text = malloc(length + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, length, stream), length);
    text[length] = 0;
    (void)fclose(stream);
    return text;
}

void bench_delete(const char *name)
{
    (void)unlink(bench_path(name));
}

pid_t bench_start(const char *arguments)
{
    char words[1024], *argument[40] = {ROTID_PROGRAM}, *rest = NULL, folder[512];
    int count = 1;
    posix_spawn_file_actions_t actions;
    pid_t child;
    (void)snprintf(words, sizeof words, "%s", arguments);
    for (char *word = strtok_r(words, " ", &rest); word && count < 39; word = strtok_r(NULL, " ", &rest)) {
        for (char *c = word; *c; c++)
            *c = *c == '%' ? ' ' : *c;
        argument[count++] = word;
    }
    assert_non_null(getcwd(folder, sizeof folder));
    assert_int_equal(chdir(bench_folder), 0);
    assert_int_equal(posix_spawn_file_actions_init(&actions), 0);
    assert_int_equal(posix_spawn_file_actions_addopen(&actions, 1, "said", O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0600), 0);
    assert_int_equal(posix_spawn_file_actions_adddup2(&actions, 1, 2), 0);
    assert_int_equal(posix_spawn(&child, ROTID_PROGRAM, &actions, NULL, argument, environ), 0);
    (void)posix_spawn_file_actions_destroy(&actions);
    assert_int_equal(chdir(folder), 0);
    return child;
}

struct bench_outcome bench_wait(pid_t process)
{
    struct bench_outcome outcome = {0};
    int status;
    assert_true(waitpid(process, &status, 0) == process);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    char *said = bench_read("said");
    (void)snprintf(outcome.out, sizeof outcome.out, "%s", said ? said : "");
    free(said);
    return outcome;
}

struct bench_outcome bench_run(const char *arguments)
{
    return bench_wait(bench_start(arguments));
}

void bench_says(const char *arguments, int code, const char *text)
{
    struct bench_outcome outcome = bench_run(arguments);
    int good = outcome.code == code && strstr(outcome.out, text);
    if (!good)
        print_error("rotid %s: exit code %d, expected %d and \"%s\" in:\n%s\n", arguments, outcome.code, code, text, outcome.out);
    assert_true(good);
}

/* The parent of a process that has not ended, 0 where there is none: a zombie waits for nothing but its parent, and that of an
 * orphan may take its time. */
static int parent_of(int process)
{
    char path[300], line[512];
    int parent = 0;
    (void)snprintf(path, sizeof path, "/proc/%d/stat", process);
    FILE *stat = fopen(path, "rb");
    const char *behind = stat && fgets(line, sizeof line, stat) ? strrchr(line, ')') : NULL;
    if (behind && (sscanf(behind, ") %*c %d", &parent) != 1 || behind[2] == 'Z'))
        parent = 0;
    if (stat)
        (void)fclose(stat);
    return parent;
}

int bench_ends(pid_t process, double seconds)
{
    const struct timespec pause = {0, 2000000};
    int there = parent_of(process) != 0;
    for (int tries = (int)(seconds / 0.002); there && tries > 0; tries--) {
        (void)nanosleep(&pause, NULL);
        there = parent_of(process) != 0;
    }
    return !there;
}

int bench_children(pid_t process, int most, pid_t *child)
{
    DIR *stream = opendir("/proc");
    int count = 0;
    assert_non_null(stream);
    for (struct dirent *entry; (entry = readdir(stream)) && count < most;) {
        int number = atoi(entry->d_name);
        if (number > 0 && parent_of(number) == process)
            child[count++] = number;
    }
    (void)closedir(stream);
    return count;
}

int bench_lines(const char *name)
{
    char *text = bench_read(name);
    int lines = 0;
    for (const char *c = text; c && *c; c++)
        lines += *c == '\n';
    free(text);
    return lines;
}

/* Everything between a time and the end of its line goes. */
static char *timeless(const char *name)
{
    char *text = bench_read(name), *to = text;
    for (const char *from = text; from && *from;) {
        if (!strncmp(from, "\"seconds\":", 10))
            from += strcspn(from, "\n");
        else
            *to++ = *from++;
    }
    if (to)
        *to = 0;
    return text;
}

int bench_same(const char *a, const char *b)
{
    char *first = timeless(a), *second = timeless(b);
    int same = first && second && !strcmp(first, second);
    for (size_t i = 0; !same && first && second; i++)
        if (first[i] != second[i]) {
            print_error("%s and %s differ at byte %zu: \"%.60s\" and \"%.60s\"\n", a, b, i, first + (i > 20 ? i - 20 : 0),
                        second + (i > 20 ? i - 20 : 0));
            break;
        }
    free(first);
    free(second);
    return same;
}

int bench_study(struct pool *pool, const char *text, struct message_list *messages, struct study *study)
{
    struct plan *plan = POOL_NEW(pool, struct plan);
    assert_non_null(plan);
    message_open(messages, pool);
    int status = plan_read(pool, bench_write("plan.txt", text), messages, plan);
    return status ? status : study_open(pool, plan, 0, NULL, plan->seed, messages, study);
}

cJSON *bench_result(const struct study *study, long run)
{
    struct jobs jobs;
    char *line = NULL;
    jobs_open(study, &jobs);
    assert_status(study_run(&jobs, run, NULL, &line), ROTID_OK);
    jobs_close(&jobs);
    cJSON *json = cJSON_Parse(line);
    assert_non_null(json);
    assert_int_equal(line[strlen(line) - 1], '\n');
    free(line);
    return json;
}

double bench_truth(const cJSON *result, int p)
{
    const cJSON *name = get(cJSON_GetArrayItem(get(result, "parameters"), p), "name");
    return number_of(get(result, "truth"), name->valuestring);
}

double bench_number(const cJSON *result, const char *list, int i, const char *key)
{
    const cJSON *item = cJSON_GetArrayItem(get(result, list), i);
    assert_non_null(item);
    return number_of(item, key);
}
