#include "page/folder_files.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "study/digest.h"

#define LIST      ".files"
#define LIST_MOST (1 << 20) /* bytes of a list that is read */
#define KEPT_MOST 99

/* A regular file in a folder, -1 where there is none. */
static int open_file(int folder, const char *name)
{
    struct stat is;
    int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file >= 0 && (fstat(file, &is) != 0 || !S_ISREG(is.st_mode))) {
        (void)close(file);
        return -1;
    }
    return file;
}

/* 1, or 0 where it cannot be read. */
static int digest_of(int folder, const char *name, char letters[DIGEST_LETTERS + 1])
{
    char part[8192];
    struct digest digest;
    ssize_t count;
    int file = open_file(folder, name);
    if (file < 0)
        return 0;
    digest_open(&digest);
    while ((count = read(file, part, sizeof part)) > 0)
        digest_bytes(&digest, (size_t)count, part);
    (void)close(file);
    digest_letters(&digest, letters);
    return count == 0;
}

/* The next file of a folder, NULL behind the last. */
static const char *next_file(DIR *list)
{
    struct dirent *entry;
    do
        entry = readdir(list); /* NOLINT: one thread reads this folder */
    while (entry && *entry->d_name == '.');
    return entry ? entry->d_name : NULL;
}

static DIR *open_list(int folder)
{
    int again = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC); /* the stream takes its descriptor with it */
    DIR *list = again < 0 ? NULL : fdopendir(again);
    if (!list && again >= 0)
        (void)close(again);
    return list;
}

int files_list(const struct folder *folder, struct message_list *messages)
{
    char letters[DIGEST_LETTERS + 1];
    const char *text = "", *name;
    DIR *list = open_list(folder->figures);
    while (list && text && (name = next_file(list)))
        if (digest_of(folder->figures, name, letters))
            text = pool_format(folder->pool, "%s%s %s\n", text, letters, name);
    if (list)
        (void)closedir(list);
    return text ? folder_write(folder, folder->figures, LIST, text, messages) : ROTID_ERROR_MEMORY;
}

/* The list of an earlier page, NULL where there is none. */
static char *read_list(struct pool *pool, int figures)
{
    char *text = NULL;
    size_t length = 0;
    ssize_t count = 0;
    int file = open_file(figures, LIST);
    if (file < 0 || !(text = POOL_ARRAY(pool, char, LIST_MOST + 1))) {
        if (file >= 0)
            (void)close(file);
        return NULL;
    }
    while (length < LIST_MOST && (count = read(file, text + length, LIST_MOST - length)) > 0)
        length += (size_t)count;
    (void)close(file);
    text[length] = 0;
    return count < 0 ? NULL : text;
}

enum belongs { UNKNOWN, CHANGED, OURS };

static enum belongs whose(int figures, const char *list, const char *name)
{
    char letters[DIGEST_LETTERS + 1];
    size_t length = strlen(name);
    for (const char *line = list; *line; line += strcspn(line, "\n"), line += *line == '\n') {
        const char *listed = line + DIGEST_LETTERS + 1;
        size_t bytes = strcspn(line, "\n");
        if (bytes != DIGEST_LETTERS + 1 + length || strncmp(listed, name, length) != 0)
            continue;
        return digest_of(figures, name, letters) && !strncmp(letters, line, DIGEST_LETTERS) ? OURS : CHANGED;
    }
    return UNKNOWN;
}

/* Puts a file aside as NAME~, NAME~2, ... */
static int keep(const struct folder *folder, int figures, const char *name, struct message_list *messages)
{
    struct stat is;
    for (int i = 1; i <= KEPT_MOST; i++) {
        const char *other = i > 1 ? pool_format(folder->pool, "%s~%d", name, i) : pool_format(folder->pool, "%s~", name);
        if (!other)
            return ROTID_ERROR_MEMORY;
        if (fstatat(figures, other, &is, AT_SYMLINK_NOFOLLOW) == 0)
            continue;
        if (renameat(figures, name, figures, other) == 0)
            message_add(messages, SEVERITY_WARNING, NULL, 0, 0, "figures/%s is not as rotid wrote it, and is kept as figures/%s",
                        name, other);
        break;
    }
    return ROTID_OK;
}

/* A link is nothing of its own that could be lost. */
static int is_regular(int folder, const char *name)
{
    struct stat is;
    return fstatat(folder, name, &is, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(is.st_mode);
}

int files_prepare(const struct folder *folder, int figures, struct message_list *messages)
{
    struct stat is;
    const char *name;
    int status = ROTID_OK, count = 0;
    size_t room = 0;
    char **all = NULL;
    const char *list = read_list(folder->pool, figures);
    DIR *entries = list ? open_list(figures) : NULL;
    while (entries && !status && (name = next_file(entries))) { /* the folder changes below, so its names are taken first */
        all = pool_grow(folder->pool, all, (size_t)count, &room, sizeof *all);
        if (!all || !(all[count++] = pool_copy_text(folder->pool, name)))
            status = ROTID_ERROR_MEMORY;
    }
    if (entries)
        (void)closedir(entries);
    for (int i = 0; i < count && !status; i++) {
        enum belongs belongs = whose(figures, list, all[i]);
        size_t length = strlen(all[i]);
        int again = fstatat(folder->figures, all[i], &is, AT_SYMLINK_NOFOLLOW) == 0,
            script = length > 3 && !strcmp(all[i] + length - 3, ".gp");
        if (!again && belongs == OURS)
            (void)unlinkat(figures, all[i], 0);
        if (again && is_regular(figures, all[i]) && (belongs == UNKNOWN || (belongs == CHANGED && script)))
            status = keep(folder, figures, all[i], messages);
    }
    return status;
}
