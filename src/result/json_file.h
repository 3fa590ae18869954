/* JSON out of a file: one value, or one a line. */
#ifndef ROTID_RESULT_JSON_FILE_H
#define ROTID_RESULT_JSON_FILE_H

#include <cJSON.h>

#include "base/message.h"

#define JSON_FILE_MOST   (64L << 20) /* bytes */
#define JSON_MEMORY_MOST 10          /* bytes of memory for a byte of text, and */
#define JSON_MEMORY_FREE (64L << 20) /* as many in any case */

/* A value of JSON takes 80 bytes once it is read, and may be written with two. Where in text [length] the values take more memory
 * than is allowed, NULL where they do not; results of rotid take 4 to 7 times their size. */
const char *json_text_too_dense(const char *text, size_t length);

/* *json (to be freed with cJSON_Delete) is the value, or an array of the values where the file has one a line; is_lines tells. Of
 * such a file a last line that no line feed ends is left out, with a note: a program died while it wrote. ROTID_OK,
 * ROTID_ERROR_IO, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY, with the mistake in the messages, at file:line:column. */
int json_file_read(struct pool *pool, const char *file, struct message_list *messages, cJSON **json, int *is_lines);

#endif
