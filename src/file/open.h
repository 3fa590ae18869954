/* How files are opened, for reading and for writing: a named pipe whose other end nobody opens does not hold the caller for ever.
 */
#ifndef ROTID_FILE_OPEN_H
#define ROTID_FILE_OPEN_H

#include <stdio.h>
#include <sys/stat.h>

/* A program at the other end of a named pipe is waited for this long: it may have been started a moment later. */
#define FILE_WAIT 5.0 /* s */

/* Opens what is there for reading and waits for nobody; *about as by fstat. A descriptor that does not wait while it is read
 * either (regular files never do), or -1 with errno. */
int file_descriptor(const char *path, struct stat *about);

/* The stream of a regular file, NULL with errno for what is absent or something else (EISDIR, EINVAL). */
FILE *file_open_regular(const char *path, struct stat *about);

/* The stream of a file, a device, a pipe (/dev/stdin, <(...)) or a named pipe, which reads as usual from then on; NULL with
 * errno: EISDIR, ENXIO for a named pipe into which nobody wrote within FILE_WAIT, EINTR where a signal ended the waiting.
 * unbuffered: the caller has a buffer of its own. */
FILE *file_open(const char *path, int unbuffered, struct stat *about);

/* The stream of a device or a pipe that is there, for writing; NULL with errno: ENXIO for a named pipe from which nobody read
 * within FILE_WAIT, EINTR. */
FILE *file_open_device(const char *path);

#define FILE_NOBODY "nobody is at the other end of this pipe"

/* host_error_text, but for ENXIO, whose text of the system says nothing about pipes. */
const char *file_error_text(int number, char *text);

#endif
