/* Texts for a person: causes by name, files without their folders. */
#include <ctype.h>

#include "diagnose/causes/causes.h"
#include "page/page.h"

/* Ids whose words a reader would have to turn round. */
static const char *const names[][2] = {{"beam_theory", "error of beam theory"},
                                       {"guyan_reduction", "Guyan condensation"},
                                       {"stiffness_local", "soft zone"},
                                       {"support_extra", "extra support"},
                                       {"support_rotation", "extra rotational support"}};

const char *plain_cause(struct pool *pool, const char *id)
{
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(names[i][0], id))
            return names[i][1];
    char *words = pool_copy_text(pool, id);
    for (char *c = words; c && *c; c++)
        *c = *c == '_' ? ' ' : *c;
    return words ? words : "";
}

const char *plain_file(const char *path)
{
    const char *slash = path && *path == '/' ? strrchr(path, '/') : NULL;
    return slash && slash[1] ? slash + 1 : path;
}

/* Bytes of the folders of an absolute path at `text`, 0 where none stands there. */
static size_t folders_at(const char *text)
{
    size_t length = strcspn(text, " \t\n\"'`,;()<>"), last = length;
    while (last && text[last - 1] != '/')
        last--;
    return *text == '/' && last > 1 && last < length ? last : 0;
}

/* Bytes of the id of a cause at `text`, which becomes *words; 0 where none stands there. */
static size_t cause_at(struct pool *pool, const char *text, const char **words)
{
    char id[64];
    size_t length = strspn(text, "abcdefghijklmnopqrstuvwxyz_");
    if (!length || length >= sizeof id || !memchr(text, '_', length) || isalnum((unsigned char)text[length]))
        return 0;
    if ((text[length] == '.' || text[length] == '-' || text[length] == '/') && isalnum((unsigned char)text[length + 1]))
        return 0; /* a part of a name: added_mass.inp */
    memcpy(id, text, length);
    id[length] = 0;
    if (!catalogue_find(id))
        return 0;
    *words = plain_cause(pool, id);
    return length;
}

/* The next place from `text` on where something is to be changed: what it takes and what stands there instead; NULL of none. */
static const char *next_change(struct pool *pool, const char *text, char before, size_t *takes, const char **words)
{
    for (; *text; before = *text++) {
        if (isalnum((unsigned char)before) || (before && strchr("_.-/", before)))
            continue;
        *words = "";
        *takes = *text == '/' ? (before == ':' ? 0 : folders_at(text)) /* https: */
                              : cause_at(pool, text, words);
        if (*takes)
            return text;
    }
    return NULL;
}

const char *plain_text(struct pool *pool, const char *text)
{
    size_t takes;
    const char *words, *at = text ? next_change(pool, text, ' ', &takes, &words) : NULL, *done = "", *rest = text;
    if (!at)
        return text;
    while (at) {
        done = pool_text(pool, "%s%.*s%s", done, (int)(at - rest), rest, words);
        rest = at + takes;
        at = next_change(pool, rest, rest[-1], &takes, &words);
    }
    return pool_text(pool, "%s%s", done, rest);
}

const char *cause_label(struct pool *pool, const rotid_diagnosis *d, const rotid_cause *cause)
{
    return diagnosis_is_suspected(d, cause) ? cause->name : cause_name(pool, cause->id, cause->target);
}

const char *extended_label(struct pool *pool, const rotid_diagnosis *d, int i)
{
    const rotid_verdict *v = &d->verdict;
    return cause_label(pool, d, i < v->ncauses ? &v->causes[i] : &v->likely_causes[i - v->ncauses]);
}
