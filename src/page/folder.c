#include "page/folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "page/document.h"
#include "page/folder_files.h"

#define PAGE      "index.html"
#define FIGURES   "figures"
#define MARK_ROOM 1024 /* bytes of a page in which its mark stands */

static int say(struct message_list *messages, const char *path, const char *what, int status)
{
    message_add(messages, SEVERITY_ERROR, NULL, 0, 0, "cannot write %s: %s", path, what);
    return status;
}

/* A folder in a folder, -1 with errno where that is none or a symbolic link. */
static int open_in(int folder, const char *name)
{
    return openat(folder, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

/* 1: a page that rotid wrote, 0: another file, -1: none. */
static int is_ours(int folder)
{
    char text[MARK_ROOM + 1];
    struct stat is;
    ssize_t length = -1;
    int page = openat(folder, PAGE, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (page < 0)
        return errno == ENOENT ? -1 : 0;
    if (fstat(page, &is) == 0 && S_ISREG(is.st_mode))
        length = read(page, text, MARK_ROOM);
    (void)close(page);
    text[length > 0 ? length : 0] = 0;
    return strstr(text, DOCUMENT_MARK) != NULL;
}

/* Of a folder that exists: refuses one with files that would be lost and are not of rotid. */
static int check(struct folder *folder, int count, struct figure *const figure[], struct message_list *messages)
{
    static const char *const ending[] = {".gp", ".svg", ".pdf"};
    struct stat is;
    int ours = is_ours(folder->final);
    if (!ours)
        return say(messages, folder->path, "its " PAGE " is no page of rotid, expected a new folder or one of an earlier report",
                   ROTID_ERROR_ARGUMENT);
    if (fstatat(folder->final, FIGURES, &is, AT_SYMLINK_NOFOLLOW) != 0)
        return ROTID_OK;
    if (!S_ISDIR(is.st_mode))
        return say(messages, folder->path,
                   S_ISLNK(is.st_mode) ? "its " FIGURES " is a symbolic link, which is not followed, expected a folder or none"
                                       : "its " FIGURES " is no folder, expected none or one",
                   ROTID_ERROR_ARGUMENT);
    for (int i = 0; i < count && ours < 0; i++)
        for (size_t e = 0; e < sizeof ending / sizeof *ending; e++) {
            const char *name = pool_format(folder->pool, FIGURES "/%s%s", figure[i]->id, ending[e]),
                       *path = name ? pool_format(folder->pool, "%s/%s", folder->path, name) : NULL;
            if (path && fstatat(folder->final, name, &is, AT_SYMLINK_NOFOLLOW) == 0)
                return say(messages, path, "there is a file of that name without a page of rotid, expected a new folder",
                           ROTID_ERROR_ARGUMENT);
        }
    return ROTID_OK;
}

static const char *last_part(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Makes the folder to work in: a status with errno. */
static int open_work(struct folder *folder)
{
    char *beside = pool_format(folder->pool, folder->exists ? "%s/.report.XXXXXX" : "%s.XXXXXX", folder->path);
    if (!beside)
        return ROTID_ERROR_MEMORY;
    if (!mkdtemp(beside))
        return ROTID_ERROR_IO;
    folder->beside = beside;
    folder->work = folder->exists ? open_in(folder->final, last_part(beside)) : open_in(AT_FDCWD, beside);
    if (folder->work < 0 || mkdirat(folder->work, FIGURES, 0777) != 0)
        return ROTID_ERROR_IO;
    folder->figures = open_in(folder->work, FIGURES);
    return folder->figures < 0 ? ROTID_ERROR_IO : ROTID_OK;
}

int folder_open(struct pool *pool, const char *path, int count, struct figure *const figure[], struct message_list *messages,
                struct folder *folder)
{
    struct stat is;
    size_t length = strlen(path);
    char *clean = pool_copy_text(pool, path);
    if (!clean)
        return ROTID_ERROR_MEMORY;
    while (length > 1 && clean[length - 1] == '/')
        clean[--length] = 0;
    *folder = (struct folder){.pool = pool, .path = clean, .final = -1, .work = -1, .figures = -1};
    if (!*path)
        return say(messages, path, "it has no name", ROTID_ERROR_IO);
    folder->exists = stat(clean, &is) == 0;
    if (folder->exists && !S_ISDIR(is.st_mode))
        return say(messages, path, "is a file, expected a folder or a new name", ROTID_ERROR_ARGUMENT);
    int status = ROTID_OK;
    if (folder->exists) {
        folder->final = open(clean, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        status =
            folder->final < 0 ? say(messages, path, strerror(errno), ROTID_ERROR_IO) : check(folder, count, figure, messages);
    }
    if (!status) {
        status = open_work(folder);
        if (status == ROTID_ERROR_IO)
            (void)say(messages, path, strerror(errno), status);
    }
    if (status)
        folder_abandon(folder);
    return status;
}

int folder_write(const struct folder *folder, int where, const char *name, const char *text, struct message_list *messages)
{
    int file = openat(where, name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666), failed = file < 0, reason = errno;
    for (size_t length = strlen(text); !failed && length;) {
        ssize_t written = write(file, text, length);
        if (written < 0 && errno == EINTR)
            continue;
        failed = written < 0;
        reason = errno;
        text += failed ? 0 : written;
        length -= failed ? 0 : (size_t)written;
    }
    if (!failed && fsync(file) != 0) {
        failed = 1;
        reason = errno;
    }
    if (file >= 0 && close(file) != 0 && !failed) {
        failed = 1;
        reason = errno;
    }
    return failed ? say(messages, folder->path, strerror(reason), ROTID_ERROR_IO) : ROTID_OK;
}

/* Calls act(from, name, to) for what is in a folder of our own. 0, or the first that is not, with errno. */
static int each(int from, int to, int (*act)(int from, const char *name, int to))
{
    int again = open_in(from, "."), failed = again < 0; /* the stream takes its descriptor with it */
    DIR *list = failed ? NULL : fdopendir(again);
    struct dirent *entry;
    if (!list) {
        if (!failed)
            (void)close(again);
        return 1;
    }
    while (!failed && (entry = readdir(list))) /* NOLINT: one thread reads this folder */
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            failed = act(from, entry->d_name, to);
    int reason = errno;
    (void)closedir(list);
    errno = reason;
    return failed;
}

static int remove_file(int from, const char *name, int to)
{
    (void)to;
    (void)unlinkat(from, name, 0);
    return 0;
}

static int move_file(int from, const char *name, int to)
{
    return renameat(from, name, to, name);
}

/* As readable as any other folder of the user: mkdtemp makes private ones. */
static void open_up(int folder)
{
    mode_t mask = umask(0);
    (void)umask(mask);
    (void)fchmod(folder, 0777 & ~mask);
}

/* Into the folder that exists: 1 with errno where something failed. */
static int move_all(const struct folder *folder, struct message_list *messages)
{
    if (mkdirat(folder->final, FIGURES, 0777) != 0 && errno != EEXIST)
        return 1;
    int figures = open_in(folder->final, FIGURES);
    if (figures < 0)
        return 1;
    errno = ENOMEM;
    int failed = files_prepare(folder, figures, messages) || each(folder->figures, figures, move_file) || move_file(folder->work, PAGE, folder->final) != 0, reason = errno;
    (void)close(figures);
    errno = reason;
    return failed;
}

static void close_all(struct folder *folder)
{
    int *const descriptor[] = {&folder->figures, &folder->work, &folder->final};
    for (int i = 0; i < 3; i++) {
        if (*descriptor[i] >= 0)
            (void)close(*descriptor[i]);
        *descriptor[i] = -1;
    }
}

int folder_close(struct folder *folder, struct message_list *messages)
{
    int failed;
    if (!folder->exists) {
        open_up(folder->work);
        failed = rename(folder->beside, folder->path) != 0;
    } else {
        failed = move_all(folder, messages);
    }
    if (failed)
        (void)say(messages, folder->path, strerror(errno), ROTID_ERROR_IO);
    if (failed || folder->exists)
        folder_abandon(folder);
    close_all(folder);
    return failed ? ROTID_ERROR_IO : ROTID_OK;
}

void folder_abandon(struct folder *folder)
{
    if (folder->figures >= 0)
        (void)each(folder->figures, -1, remove_file);
    if (folder->work >= 0) {
        (void)unlinkat(folder->work, FIGURES, AT_REMOVEDIR);
        (void)each(folder->work, -1, remove_file);
    }
    if (folder->beside)
        (void)unlinkat(folder->exists ? folder->final : AT_FDCWD, folder->exists ? last_part(folder->beside) : folder->beside,
                       AT_REMOVEDIR);
    close_all(folder);
}
