#include "page/folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "file/open.h"
#include "page/document.h"
#include "report/output.h"

#define PAGE      "index.html"
#define FIGURES   "figures"
#define MARK_ROOM 1024 /* bytes of a page in which its mark stands */

static int say(struct message_list *messages, const char *path, const char *what, int status)
{
    message_add(messages, SEVERITY_ERROR, NULL, 0, 0, "cannot write %s: %s", path, what);
    return status;
}

static const char *join(struct pool *pool, const char *folder, const char *name)
{
    const char *path = pool_format(pool, "%s/%s", folder, name);
    return path ? path : "";
}

/* 1: a page that rotid wrote, 0: another file, -1: none. */
static int is_ours(const char *page)
{
    char text[MARK_ROOM + 1];
    struct stat is;
    FILE *stream = file_open_regular(page, &is);
    if (!stream)
        return errno == ENOENT ? -1 : 0;
    size_t length = fread(text, 1, MARK_ROOM, stream);
    (void)fclose(stream);
    text[length] = 0;
    return strstr(text, DOCUMENT_MARK) != NULL;
}

/* Of a folder that exists: refuses one with files that would be lost and are not of rotid. */
static int check(struct folder *folder, int count, struct figure *const figure[], struct message_list *messages)
{
    static const char *const ending[] = {".gp", ".svg", ".pdf"};
    struct stat is;
    const char *figures = join(folder->pool, folder->path, FIGURES);
    int ours = is_ours(join(folder->pool, folder->path, PAGE));
    if (!ours)
        return say(messages, folder->path, "its " PAGE " is no page of rotid, expected a new folder or one of an earlier report",
                   ROTID_ERROR_ARGUMENT);
    if (stat(figures, &is) != 0)
        return ROTID_OK;
    if (!S_ISDIR(is.st_mode))
        return say(messages, folder->path, "its " FIGURES " is no folder, expected none or one", ROTID_ERROR_ARGUMENT);
    for (int i = 0; i < count && ours < 0; i++)
        for (size_t e = 0; e < sizeof ending / sizeof *ending; e++) {
            const char *path = pool_format(folder->pool, "%s/%s%s", figures, figure[i]->id, ending[e]);
            if (path && lstat(path, &is) == 0)
                return say(messages, path, "there is a file of that name without a page of rotid, expected a new folder",
                           ROTID_ERROR_ARGUMENT);
        }
    return ROTID_OK;
}

int folder_open(struct pool *pool, const char *path, int count, struct figure *const figure[], struct message_list *messages,
                struct folder *folder)
{
    struct stat is;
    size_t length = strlen(path);
    char *clean = pool_copy_text(pool, path), *beside;
    if (!clean)
        return ROTID_ERROR_MEMORY;
    while (length > 1 && clean[length - 1] == '/')
        clean[--length] = 0;
    *folder = (struct folder){.pool = pool, .path = clean};
    folder->exists = stat(clean, &is) == 0;
    if (folder->exists && !S_ISDIR(is.st_mode))
        return say(messages, path, "is a file, expected a folder or a new name", ROTID_ERROR_ARGUMENT);
    int status = folder->exists ? check(folder, count, figure, messages) : ROTID_OK;
    if (status)
        return status;
    beside = pool_format(pool, folder->exists ? "%s/.report.XXXXXX" : "%s.XXXXXX", clean);
    if (!beside)
        return ROTID_ERROR_MEMORY;
    if (!*path || !mkdtemp(beside))
        return say(messages, path, *path ? strerror(errno) : "it has no name", ROTID_ERROR_IO);
    folder->beside = beside;
    folder->figures = join(pool, beside, FIGURES);
    if (mkdir(folder->figures, 0777) != 0) {
        status = say(messages, path, strerror(errno), ROTID_ERROR_IO);
        (void)rmdir(beside);
    }
    return status;
}

int folder_write(const struct folder *folder, const char *name, const char *text, struct message_list *messages)
{
    const char *path = join(folder->pool, folder->beside, name);
    if (!output_write(path, text))
        return ROTID_OK;
    return say(messages, folder->path, strerror(errno), ROTID_ERROR_IO);
}

/* Calls act(from/name) for what is in a folder of our own. 0, or the first status that is not. */
static int each(struct folder *folder, const char *from, int (*act)(struct folder *folder, const char *path, const char *name))
{
    DIR *list = opendir(from);
    int status = list ? ROTID_OK : ROTID_ERROR_IO;
    struct dirent *entry;
    while (!status && list && (entry = readdir(list))) /* NOLINT: one thread reads this folder */
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            status = act(folder, join(folder->pool, from, entry->d_name), entry->d_name);
    int reason = errno;
    if (list)
        (void)closedir(list);
    errno = reason;
    return status;
}

static int remove_file(struct folder *folder, const char *path, const char *name)
{
    (void)folder, (void)name;
    (void)unlink(path);
    return ROTID_OK;
}

static int move_figure(struct folder *folder, const char *path, const char *name)
{
    const char *final = pool_format(folder->pool, "%s/" FIGURES "/%s", folder->path, name);
    return final && rename(path, final) == 0 ? ROTID_OK : ROTID_ERROR_IO;
}

/* As readable as any other folder of the user: mkdtemp makes private ones. */
static void open_up(const char *path)
{
    mode_t mask = umask(0);
    (void)umask(mask);
    (void)chmod(path, 0777 & ~mask);
}

int folder_close(struct folder *folder, struct message_list *messages)
{
    int status = ROTID_OK;
    if (!folder->exists) {
        open_up(folder->beside);
        status = rename(folder->beside, folder->path) == 0 ? ROTID_OK : ROTID_ERROR_IO;
    } else {
        if (mkdir(join(folder->pool, folder->path, FIGURES), 0777) != 0 && errno != EEXIST)
            status = ROTID_ERROR_IO;
        if (!status)
            status = each(folder, folder->figures, move_figure);
        if (!status && rename(join(folder->pool, folder->beside, PAGE), join(folder->pool, folder->path, PAGE)) != 0)
            status = ROTID_ERROR_IO;
    }
    if (status)
        (void)say(messages, folder->path, strerror(errno), status);
    if (status || folder->exists)
        folder_abandon(folder);
    return status;
}

void folder_abandon(struct folder *folder)
{
    (void)each(folder, folder->figures, remove_file);
    (void)rmdir(folder->figures);
    (void)each(folder, folder->beside, remove_file);
    (void)rmdir(folder->beside);
}
