/* The text of a header as tokens, and its #define lines. */
#ifndef ROTID_TESTS_HEADER_TOKENS_H
#define ROTID_TESTS_HEADER_TOKENS_H

#include "base/base.h"

enum token_kind { TOKEN_END, TOKEN_NAME, TOKEN_NUMBER, TOKEN_TEXT, TOKEN_MARK };

struct token {
    enum token_kind kind;
    const char *text; /* of a text constant: without its quotes; a mark is one character */
    int line;
};

/* #define name value, or #define name(parameter, ...) value: the tokens of the value, ended by TOKEN_END. */
struct define {
    const char *name, *parameter; /* the first parameter; NULL where there is none */
    const struct token *value;
    int line;
};

struct tokens {
    const struct token *token; /* ended by TOKEN_END; without comments and lines of the preprocessor */
    int ndefine;
    const struct define *define;
};

/* As a C compiler sees the text: what stands under #ifdef __cplusplus is left out, of every other condition the first branch is
 * taken. 0, or -1 with the line and what is wrong in it. */
int tokens_read(struct pool *pool, const char *text, struct tokens *tokens, int *line, const char **error);

#endif
