#include "page/gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "page/picture.h"
#include "page/process.h"

#define SECONDS      120.0       /* for one run: a page takes two */
#define MOST_SVG     (64L << 20) /* bytes */
#define MOST_PATH    4096
#define OLDEST_MAJOR 5
#define OLDEST_MINOR 2

int gnuplot_find(struct pool *pool, const rotid_environment *environment, struct gnuplot *gnuplot)
{
    const char *stated = getenv("GNUPLOT"), *words; /* NOLINT: nobody sets it meanwhile */
    char here[MOST_PATH];
    int major = 0, minor = 0;
    struct process_result *run = POOL_NEW(pool, struct process_result);
    *gnuplot = (struct gnuplot){.path = stated && *stated ? stated : "gnuplot"};
    if (*gnuplot->path != '/' && strchr(gnuplot->path, '/') && getcwd(here, sizeof here)) /* it is run elsewhere */
        gnuplot->path = pool_format(pool, "%s/%s", here, gnuplot->path);
    if (!run || !gnuplot->path)
        return ROTID_ERROR_MEMORY;
    const char *const argv[] = {gnuplot->path, "--version", NULL};
    int status = process_run(argv, PROCESS_HERE, SECONDS, environment, run);
    words = strstr(run->out, "gnuplot ");
    if (status)
        gnuplot->why = pool_format(pool, "%s could not be run: %s", gnuplot->path, strerror(errno));
    else if (run->exit_code || !words || sscanf(words, "gnuplot %d.%d", &major, &minor) != 2) /* NOLINT: two small numbers */
        gnuplot->why = pool_format(pool, "%s does not tell its version", gnuplot->path);
    else if (major < OLDEST_MAJOR || (major == OLDEST_MAJOR && minor < OLDEST_MINOR))
        gnuplot->why = pool_format(pool, "%s is version %d.%d, expected %d.%d or newer", gnuplot->path, major, minor,
                                   OLDEST_MAJOR, OLDEST_MINOR);
    else
        gnuplot->version = pool_format(pool, "%.*s", (int)strcspn(words + 8, "\n"), words + 8);
    return gnuplot->version || gnuplot->why ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The text of ID with the ending in the folder, NULL where there is none or memory is out. */
static char *read_back(struct pool *pool, int folder, const char *id, const char *ending)
{
    struct stat is;
    char *text = NULL, *name = pool_format(pool, "%s%s", id, ending);
    int file = name ? openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC) : -1;
    FILE *stream = file >= 0 ? fdopen(file, "rb") : NULL;
    if (stream && fstat(file, &is) == 0 && S_ISREG(is.st_mode) && is.st_size > 0 && is.st_size < MOST_SVG)
        text = POOL_ARRAY(pool, char, is.st_size + 1);
    if (text && fread(text, 1, (size_t)is.st_size, stream) != (size_t)is.st_size)
        text = NULL;
    if (stream)
        (void)fclose(stream);
    else if (file >= 0)
        (void)close(file);
    return text;
}

/* Takes the pictures of a figure: nonzero where they are complete. */
static int take(struct pool *pool, int folder, struct figure *figure)
{
    static const char *const ending[LAYOUTS] = {".svg", "-narrow.svg"};
    for (int l = 0; l < LAYOUTS; l++) {
        char *raw = read_back(pool, folder, figure->id, ending[l]);
        figure->picture[l] = raw ? picture_uri(pool, raw) : NULL;
    }
    if (!figure->picture[WIDE] || !figure->picture[NARROW])
        figure->picture[WIDE] = figure->picture[NARROW] = NULL;
    else
        figure->has_pdf = read_back(pool, folder, figure->id, ".pdf") != NULL;
    return figure->picture[WIDE] != NULL;
}

/* The first line of its errors that says something; a warning only where there is nothing else. */
static const char *complaint(struct pool *pool, const struct process_result *run)
{
    if (run->timed_out)
        return "gnuplot did not end and was stopped";
    const char *text = run->err;
    text += strspn(text, " \t\r\n^");
    for (const char *line = text; *line; line += strspn(line, " \t\r\n^")) {
        size_t length = strcspn(line, "\r\n");
        const char *warning = strstr(line, "warning:");
        if (!warning || warning > line + length) {
            text = line;
            break;
        }
        line += length;
    }
    const char *says = *text            ? pool_format(pool, "%.*s", (int)strcspn(text, "\r\n"), text)
                       : run->exit_code ? pool_format(pool, "gnuplot ended with exit code %d and said nothing", run->exit_code)
                                        : "gnuplot wrote no complete picture";
    return says ? says : "";
}

static int run_rest(struct pool *pool, const struct gnuplot *gnuplot, const rotid_environment *environment, int folder, int count,
                    struct figure *const figure[], struct process_result *run)
{
    const char **argv = POOL_ARRAY(pool, const char *, count + 5);
    int n = 0;
    if (!argv)
        return ROTID_ERROR_MEMORY;
    argv[n++] = gnuplot->path;
    argv[n++] = "-d"; /* nobody's own settings */
    argv[n++] = "-e";
    argv[n++] = "layouts = 'svg narrow pdf'";
    for (int i = 0; i < count; i++) {
        argv[n++] = pool_format(pool, "%s.gp", figure[i]->id);
        if (!argv[n - 1])
            return ROTID_ERROR_MEMORY;
    }
    return process_run(argv, folder, SECONDS, environment, run);
}

int gnuplot_draw(struct pool *pool, const struct gnuplot *gnuplot, const rotid_environment *environment, int folder, int count,
                 struct figure *const figure[], const char **why)
{
    struct process_result *run = POOL_NEW(pool, struct process_result);
    int next = 0, idle = 0;
    if (!run)
        return ROTID_ERROR_MEMORY;
    while (next < count) {
        int status = idle > 2 ? ROTID_OK /* it draws nothing at all */
                              : run_rest(pool, gnuplot, environment, folder, count - next, figure + next, run);
        if (status == ROTID_ERROR_MEMORY)
            return status;
        if (run->cancelled)
            return ROTID_STOP_CANCELLED;
        const char *says = status ? strerror(errno) : complaint(pool, run);
        int first = next;
        while (next < count && take(pool, folder, figure[next]))
            next++;
        idle = next == first ? idle + 1 : 0;
        if (next < count)
            why[next++] = says;
    }
    return ROTID_OK;
}
