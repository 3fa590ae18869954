/* The folder of a page: whole or not there. Everything is written into a folder beside it (or in it, where it exists), and takes
 * its names at the end. Nothing that is not a page of rotid is written over, and what an earlier page left goes (folder_files.h).
 * The name of the folder itself may be a symbolic link; within it none is followed, and what was looked at once is known by its
 * descriptor, so nobody puts another in its place.
 */
#ifndef ROTID_PAGE_FOLDER_H
#define ROTID_PAGE_FOLDER_H

#include "base/message.h"
#include "page/figure.h"

struct folder {
    struct pool *pool;
    const char *path;   /* final */
    const char *beside; /* where it is written meanwhile */
    int exists;
    int final;         /* descriptor of path where that exists, else -1 */
    int work, figures; /* of beside, and of the folder of figures in it */
};

/* Makes the folder to write in. ROTID_OK; ROTID_ERROR_ARGUMENT: path is no folder, or holds files that are not of rotid;
 * ROTID_ERROR_IO; ROTID_ERROR_MEMORY. What is wrong stands in the messages; then there is nothing to close. */
int folder_open(struct pool *pool, const char *path, int count, struct figure *const figure[], struct message_list *messages,
                struct folder *folder);
/* A new file in `where`, which is folder->work or folder->figures; ROTID_OK, or ROTID_ERROR_IO with a message. */
int folder_write(const struct folder *folder, int where, const char *name, const char *text, struct message_list *messages);
/* All of it takes its final names, the page last. ROTID_OK, or ROTID_ERROR_IO with a message and nothing left beside. */
int folder_close(struct folder *folder, struct message_list *messages);
/* Removes the written files. */
void folder_abandon(struct folder *folder);

#endif
