#include "abi.h"

/* Those that a routine makes and hands out by its address, and what a trace is told. */
static const char *const growing[] = {
    "rotid_deck",       "rotid_check",  "rotid_spectrum",   "rotid_identification", "rotid_diagnosis",
    "rotid_suggestion", "rotid_speeds", "rotid_fit_result", "rotid_lm_iteration",   NULL};

int abi_may_grow(const char *name)
{
    int i = 0;
    while (growing[i] && strcmp(growing[i], name) != 0)
        i++;
    return growing[i] != NULL;
}

long abi_major(const struct header *header)
{
    const struct header_constant *major = header_constant(header, "ROTID_VERSION_MAJOR");
    return major && major->kind == HEADER_DEFINE ? major->value : -1;
}

static int is_of(const struct header_variable *variable, const char *name, int pointers)
{
    return !variable->callback && variable->type.pointers == pointers && strcmp(variable->type.base, name) == 0;
}

int abi_says_its_size(const struct header_struct *structure)
{
    return structure->nmember && is_of(&structure->member[0], "size_t", 0) && strcmp(structure->member[0].name, "size") == 0;
}

static int takes(const struct header_function *function, const char *name, int pointers)
{
    for (int i = 0; i < function->nparameter; i++)
        if (is_of(&function->parameter[i], name, pointers))
            return 1;
    return 0;
}

int abi_cannot_grow(const struct header *header, const char *name, const char **why)
{
    int handed_out = 0;
    for (int i = 0; i < header->nstruct; i++)
        for (int j = 0; j < header->structure[i].nmember; j++) {
            const struct header_variable *member = &header->structure[i].member[j];
            if (is_of(member, name, 0)) {
                *why = "it stands in another struct by value";
                return 1;
            }
            handed_out |= member->callback && takes(member->callback, name, 1);
        }
    for (int i = 0; i < header->nfunction; i++)
        handed_out |= takes(&header->function[i], name, 2);
    for (int i = 0; i < header->ncallback; i++)
        handed_out |= takes(&header->callback[i], name, 1);
    *why = handed_out ? NULL : "no routine hands it out by its address";
    return !handed_out;
}

/* ---- the text */

static const struct header_function *without_names(struct pool *pool, const struct header_function *function);

static int without_name(struct pool *pool, const struct header_variable *variable, struct header_variable *copy)
{
    *copy = *variable;
    copy->name = "";
    if (variable->callback)
        copy->callback = without_names(pool, variable->callback);
    return variable->callback && !copy->callback ? -1 : 0;
}

static const struct header_function *without_names(struct pool *pool, const struct header_function *function)
{
    struct header_function *copy = POOL_NEW(pool, struct header_function);
    struct header_variable *parameter = POOL_ARRAY(pool, struct header_variable, function->nparameter);
    if (!copy || !parameter)
        return NULL;
    for (int i = 0; i < function->nparameter; i++)
        if (without_name(pool, &function->parameter[i], &parameter[i]))
            return NULL;
    *copy = *function;
    copy->name = "";
    copy->parameter = parameter;
    return copy;
}

/* text + "kind name = value\n"; NULL where one of them is. */
static const char *append(struct pool *pool, const char *text, const char *kind, const char *name, const char *value)
{
    return text && name && value ? pool_format(pool, "%s%s %s = %s\n", text, kind, name, value) : NULL;
}

static const char *append_struct(struct pool *pool, const char *text, const struct header_struct *structure)
{
    text = append(pool, text, "struct", structure->name,
                  abi_may_grow(structure->name)  ? "grows"
                  : abi_says_its_size(structure) ? "sized"
                                                 : "fixed");
    for (int i = 0; i < structure->nmember; i++) {
        struct header_variable member;
        if (without_name(pool, &structure->member[i], &member))
            return NULL;
        const char *type = header_variable_text(pool, &member);
        text = append(pool, text, "member", pool_format(pool, "%s.%s", structure->name, structure->member[i].name),
                      type ? pool_format(pool, "%d: %s", i + 1, type) : NULL);
    }
    return text;
}

const char *abi_text(struct pool *pool, const struct header *header)
{
    const char *text = pool_format(pool, "major %ld\n", abi_major(header));
    for (int i = 0; text && i < header->nconstant; i++) {
        const struct header_constant *constant = &header->constant[i];
        if (constant->kind != HEADER_TEXT && strncmp(constant->name, "ROTID_VERSION_", 14) != 0)
            text = append(pool, text, "constant", constant->name, pool_format(pool, "%ld", constant->value));
    }
    for (int i = 0; text && i < header->nstruct; i++)
        text = append_struct(pool, text, &header->structure[i]);
    for (int i = 0; text && i < header->ncallback; i++) {
        struct header_variable pointer = {.name = "", .callback = without_names(pool, &header->callback[i])};
        text = append(pool, text, "callback", header->callback[i].name,
                      pointer.callback ? header_variable_text(pool, &pointer) : NULL);
    }
    for (int i = 0; text && i < header->nfunction; i++) {
        const struct header_function *function = without_names(pool, &header->function[i]);
        text = append(pool, text, "function", header->function[i].name, function ? header_function_text(pool, function) : NULL);
    }
    return text;
}

/* ---- the comparison */

/* The line of the text that begins with the same "KIND NAME = " as `line`, or NULL. */
static const char *find(const char *text, const char *line)
{
    size_t length = (size_t)(strstr(line, " = ") - line) + 3;
    while (*text && strncmp(text, line, length) != 0)
        text += strcspn(text, "\n") + 1;
    return *text ? text : NULL;
}

static int same_line(const char *a, const char *b)
{
    size_t length = strcspn(a, "\n");
    return strcspn(b, "\n") == length && strncmp(a, b, length) == 0;
}

/* Is this new member of a struct that hosts know, and that may not grow: neither "grows" nor "sized". */
static int widens(struct pool *pool, const char *before, const char *line)
{
    if (strncmp(line, "member ", 7) != 0)
        return 0;
    const char *grown = pool_format(pool, "struct %.*s = ", (int)strcspn(line + 7, "."), line + 7);
    const char *known = grown ? find(before, grown) : NULL;
    return !grown || (known && strncmp(known + strlen(grown), "fixed", 5) == 0);
}

enum abi_change abi_compare(struct pool *pool, const char *before, const char *now, const char **report)
{
    const char *broken = "", *added = "";
    for (const char *line = before; broken && *line; line += strcspn(line, "\n") + 1) {
        const char *same = strstr(line, " = ") && strcspn(line, "=") < strcspn(line, "\n") ? find(now, line) : line;
        int length = (int)strcspn(line, "\n");
        if (!same)
            broken = pool_format(pool, "%sremoved: %.*s\n", broken, length, line);
        else if (!same_line(line, same))
            broken = pool_format(pool, "%schanged: %.*s, now %.*s\n", broken, length, line, (int)strcspn(same, "\n"), same);
    }
    for (const char *line = now; broken && added && *line; line += strcspn(line, "\n") + 1) {
        int length = (int)strcspn(line, "\n");
        if (strcspn(line, "=") > (size_t)length || find(before, line))
            continue;
        if (widens(pool, before, line))
            broken = pool_format(pool, "%sadded to a struct that hosts have by value or in arrays: %.*s\n", broken, length, line);
        else
            added = pool_format(pool, "%sadded: %.*s\n", added, length, line);
    }
    *report = broken && added ? pool_format(pool, "%s%s", broken, added) : NULL;
    if (!*report) {
        *report = "no memory\n";
        return ABI_BROKEN;
    }
    return *broken ? ABI_BROKEN : *added ? ABI_ADDED : ABI_SAME;
}
