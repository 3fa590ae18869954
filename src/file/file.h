#ifndef ROTID_FILE_FILE_H
#define ROTID_FILE_FILE_H

/* file: how files are opened, for reading and for writing.
 *
 * Comes in: a path. Goes out: a descriptor or a stream, or an error number for file_error_text. All of it is in open.c:
 *
 *   file_open, file_descriptor       an existing file, device or pipe for reading. A named pipe is opened without waiting; for a
 *                                    program at its other end file_open waits FILE_WAIT seconds, then returns ENXIO
 *   file_open_regular                the same, regular files only
 *   file_open_device, file_open_own  for writing: a device or pipe; a descriptor that the program was started with (/dev/stdout)
 *   file_hold_standard               takes the numbers 0, 1, 2 where they are closed, so that no file gets the place of a
 *                                    standard stream
 *
 * Files are read by src/deck (decks, tables), src/uff (universal files), src/result (JSON) and src/study (results), written by
 * src/report/output.c. The room knows nothing of what files hold and sends no messages: the caller does. */

#include <stdio.h>
#include <sys/stat.h>

/* A program at the other end of a named pipe is waited for this long: it may have been started a moment later. */
#define FILE_WAIT 5.0 /* s */

/* Takes the numbers 0, 1 and 2 where they are closed, with a directory, of which nothing is read and to which nothing is written:
 * else the next file would have these numbers, and messages on standard error would be written into that file.
 * Nonzero with errno where that fails. */
int file_hold_standard(void);

/* Opens an existing file for reading and waits for nobody; *about as by fstat. A descriptor that does not wait while it is read
 * either (regular files never do), or -1 with errno. */
int file_descriptor(const char *path, struct stat *about);

/* The stream of a regular file, NULL with errno where the path has no file or no regular one (EISDIR, EINVAL). */
FILE *file_open_regular(const char *path, struct stat *about);

/* The stream of a file, a device, a pipe (/dev/stdin, <(...)) or a named pipe, which reads as usual from then on; NULL with
 * errno: EISDIR, ENXIO for a named pipe into which nobody wrote within FILE_WAIT, EINTR where a signal ended the waiting.
 * unbuffered: the caller has a buffer of its own. */
FILE *file_open(const char *path, int unbuffered, struct stat *about);

/* The stream of a device or a pipe that is there, for writing; NULL with errno: ENXIO for a named pipe from which nobody read
 * within FILE_WAIT, EINTR. */
FILE *file_open_device(const char *path);

/* The stream of a descriptor that the program was started with, where the path is a link to it (/dev/stdout, /dev/fd/3): writes
 * behind what is there, since a rename would put a file in the place of the link and a second opening begin at its first byte.
 * NULL with errno 0 where the path is no such link, with EBADF where the descriptor is there to be read. */
FILE *file_open_own(const char *path);

#define FILE_NOBODY "nobody is at the other end of this pipe"

/* What the error number of an opening says to a caller: ROTID_ERROR_MEMORY where memory ran out, else ROTID_ERROR_IO. */
int file_status(int number);

/* host_error_text, but for ENXIO, whose text of the system says nothing about pipes. */
const char *file_error_text(int number, char *text);

#endif
