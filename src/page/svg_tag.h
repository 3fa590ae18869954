/* One tag of an SVG of gnuplot: what it says, and how it is written for a page. */
#ifndef ROTID_PAGE_SVG_TAG_H
#define ROTID_PAGE_SVG_TAG_H

#include "base/pool.h"

#define SVG_NAME       16
#define SVG_ATTRIBUTES 24

struct svg_attribute { /* pieces of the text */
    const char *name, *value;
    int name_length, value_length;
};

struct svg_tag {
    char name[SVG_NAME];
    int closes, is_empty; /* </name>, <name/> */
    int count;
    struct svg_attribute attribute[SVG_ATTRIBUTES];
    char value[128]; /* of the last attribute asked for */
};

/* The tag at `at`, which is '<'; comments have the name "!". The place behind it, or NULL where it is none. */
const char *svg_tag_read(const char *at, const char *end, struct svg_tag *tag);

/* The value of an attribute, "" where there is none; good until the next call. */
const char *svg_attribute(struct svg_tag *tag, const char *name);

/* The tag as it stands in a page, "" for a comment (pool; NULL: memory is out). Identifiers, kept within <defs> alone, and
 * references to them get the prefix; colours become classes. used: the identifier it refers to, or "". */
char *svg_tag_text(struct pool *pool, const struct svg_tag *tag, const char *prefix, int in_defs, char *used, size_t room);

#endif
