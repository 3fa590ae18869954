/* A JSON object under construction. A failed allocation anywhere is remembered, so that a result is whole or not there. */
#ifndef ROTID_RESULT_JSON_TREE_H
#define ROTID_RESULT_JSON_TREE_H

#include <cJSON.h>

struct json_tree {
    cJSON *root;
    int failed;
};

void json_open(struct json_tree *tree);
/* The text, which ends in a line feed, to be freed with json_free, or NULL where memory was out. The tree is gone then. */
char *json_close(struct json_tree *tree);
void json_free(char *text);
/* The same without a blank, in one line. */
char *json_close_line(struct json_tree *tree);

/* Each adds to an object under `key`, to an array where `key` is NULL; nothing and a mark on the tree where `parent` is NULL. */
cJSON *json_object(struct json_tree *tree, cJSON *parent, const char *key);
cJSON *json_array(struct json_tree *tree, cJSON *parent, const char *key);
void json_null(struct json_tree *tree, cJSON *parent, const char *key);
void json_flag(struct json_tree *tree, cJSON *parent, const char *key, int value);
/* null where the value is not finite */
void json_number(struct json_tree *tree, cJSON *parent, const char *key, double value);
/* In whatever encoding: bytes that are not UTF-8 become U+FFFD; null where there is no text. */
void json_text(struct json_tree *tree, cJSON *parent, const char *key, const char *text);
/* The same with nine significant digits, for arrays that are drawn and not computed with: an array of the length of a mesh takes
 * a third of the room, and one node of the tree. */
void json_digits(struct json_tree *tree, cJSON *parent, const char *key, int count, const double *value);
/* A number rounded to that. */
void json_rounded(struct json_tree *tree, cJSON *parent, const char *key, double value);
/* Rows of a column-major matrix, in full or with nine significant digits. */
void json_digit_rows(struct json_tree *tree, cJSON *parent, const char *key, int rows, int columns, const double *value);
void json_matrix(struct json_tree *tree, cJSON *parent, const char *key, int rows, int columns, const double *value);

#endif
