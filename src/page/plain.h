/* Texts as a page shows them outside its last section: causes by name, files without their folders. */
#ifndef ROTID_PAGE_PLAIN_H
#define ROTID_PAGE_PLAIN_H

#include "base/pool.h"

/* The name of a cause of the catalogue in words: "soft zone" of stiffness_local; of another id the id with blanks for _. On the
 * pool; "" where memory is out. */
const char *plain_cause(struct pool *pool, const char *id);

/* The text with the name in words of every cause whose id has a _ and stands as a word of its own, and of every absolute path
 * with a folder its last part: "added_mass of /a/b/rotor.inp" is "added mass of rotor.inp". On the pool, or the text itself where
 * there is nothing to change or memory is out. NULL of NULL. */
const char *plain_text(struct pool *pool, const char *text);

/* The last part of an absolute path; another path as it is. */
const char *plain_file(const char *path);

#endif
