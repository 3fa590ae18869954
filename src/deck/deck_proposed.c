#include "deck/deck.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "deck/card_table.h"
#include "file/file.h"
#include "suggest/suggest.h"

#define WIDER 1e3 /* bounds of the stiffness of a support, from its start */

/* A number in the unit of the deck, which is `unit` in SI (0: SI), to 15 digits: that a quotient is rounded should not show. */
static void put_in(struct deck_writer *w, const char *separator, double value, double unit)
{
    char text[DECK_NUMBER_LENGTH];
    if (unit > 0 && unit != 1) {
        (void)snprintf(text, sizeof text, "%.14e", value / unit);
        value = strtod(text, NULL);
    }
    deck_put_number(w, separator, value);
}

/* The unit of the deck of "k" or "k_rot": *UNITS states none of a rotational stiffness. */
static double unit_of(const struct deck_writer *w, const char *parameter)
{
    return strcmp(parameter, "k") ? 0 : w->job->units.stiffness;
}

static void put_value(struct deck_writer *w, const char *name, const char *parameter, double value)
{
    deck_put(w, "%s.%s", name, parameter);
    put_in(w, ", ", value, unit_of(w, parameter));
    deck_put(w, "\n");
}

/* The unknown of this state alone that takes the place of a common one. */
static void put_unknown(struct deck_writer *w, const char *name, const char *parameter, double value)
{
    deck_put(w, "*IDENTIFY\n%s.%s", name, parameter);
    put_in(w, ", ", value / WIDER, unit_of(w, parameter));
    put_in(w, ", ", value * WIDER, unit_of(w, parameter));
    put_in(w, ", ", value, unit_of(w, parameter));
    deck_put(w, "\n");
}

static int is_unknown(const struct job *job, enum parameter_kind kind, int spring)
{
    for (int p = 0; p < job->unknowns.nparameter; p++)
        if (job->unknowns.parameter[p].kind == kind && job->unknowns.parameter[p].index == spring)
            return 1;
    return 0;
}

static void put_stiffness(struct deck_writer *w, int spring, const char *name, enum parameter_kind kind, double value)
{
    const char *parameter = kind == PARAMETER_SPRING_K ? "k" : "k_rot";
    if (!(value > 0))
        return;
    if (is_unknown(w->job, kind, spring)) {
        put_unknown(w, name, parameter, value);
    } else {
        deck_put(w, "*SET\n");
        put_value(w, name, parameter, value);
    }
}

/* A support that goes elsewhere is hardly there any more, and there is another one. */
static void put_moved(struct deck_writer *w, const struct test *test)
{
    const struct spring *spring = &w->job->rotor.spring[test->spring];
    const char *name = pool_format(w->pool, "%s_moved", spring->name);
    w->status = name ? w->status : ROTID_ERROR_MEMORY;
    deck_put(w, "*SET\n");
    put_value(w, spring->name, "k", spring->lateral * TEST_SOFTER * TEST_SOFTER);
    if (spring->rotational > 0)
        put_value(w, spring->name, "k_rot", spring->rotational * TEST_SOFTER * TEST_SOFTER);
    deck_put(w, "*SPRING, NAME=%s\n", name ? name : "");
    put_in(w, "", test->z, w->job->units.length);
    put_in(w, ", ", spring->lateral, w->job->units.stiffness);
    if (spring->rotational > 0)
        deck_put_number(w, ", ", spring->rotational);
    deck_put(w, "\n");
    if (is_unknown(w->job, PARAMETER_SPRING_K, test->spring) && name)
        put_unknown(w, name, "k", spring->lateral);
}

static void put_supports(struct deck_writer *w, const struct test *test)
{
    const struct rotor *rotor = &w->job->rotor;
    double factor = test->kind == TEST_STIFF ? TEST_STIFFER : TEST_SOFTER;
    for (int s = 0; s < rotor->nspring; s++) {
        if (!rotor->spring[s].name) {
            w->status = w->status ? w->status : ROTID_ERROR_ARGUMENT;
            return;
        }
        put_stiffness(w, s, rotor->spring[s].name, PARAMETER_SPRING_K, rotor->spring[s].lateral * factor);
        put_stiffness(w, s, rotor->spring[s].name, PARAMETER_SPRING_K_ROT, rotor->spring[s].rotational * factor);
    }
}

static void put_change(struct deck_writer *w, const struct test *test)
{
    switch (test->kind) {
    case TEST_MASS:
        deck_put(w, "*DISK, NAME=known_mass\n");
        put_in(w, "", test->z, w->job->units.length);
        put_in(w, ", ", test->mass, w->job->units.mass);
        deck_put(w, "\n");
        break;
    case TEST_STIFF:
    case TEST_FREE:
        put_supports(w, test);
        break;
    case TEST_MOVED:
        if (!w->job->rotor.spring[test->spring].name)
            w->status = ROTID_ERROR_ARGUMENT;
        else
            put_moved(w, test);
        break;
    default:
        break;
    }
}

static void put_sensors(struct deck_writer *w, const struct test *test)
{
    struct job planned;
    int status = planned_sensors(w->pool, w->job, test->nsensor, test->sensor, &planned);
    w->status = w->status ? w->status : status;
    for (int s = 0; s < test->nsensor && !w->status; s++) {
        if (s % DECK_MOST_LINES == 0)
            deck_put(w, "*SENSORS\n");
        deck_put(w, "%d", planned.rotor.sensor[s].id);
        put_in(w, ", ", planned.rotor.sensor[s].position, w->job->units.length);
        deck_put(w, "\n");
    }
    if (test->nsensor)
        deck_put(w, "** the shapes, once for each mode; or all of it as *MEASURED, FILE=\n** *SHAPE, MODE=%d\n", test->number[0]);
    for (int s = 0; s < test->nsensor && !w->status; s++)
        deck_put(w, "** %d, \n", planned.rotor.sensor[s].id);
}

int deck_write_test(struct pool *pool, const struct job *job, const struct test *test, char **text)
{
    struct deck_writer w = {.pool = pool, .job = job, .rotor = job->rotor};
    const char *what = test_text(pool, job, test);
    *text = NULL;
    deck_put(&w, "** proposed by rotid suggest: %s\n*STATE, NAME=%s\n", what ? what : "", test_id(test->kind));
    put_change(&w, test);
    deck_put_card(&w, "NOISE");
    deck_put_option_number(&w, "FREQUENCY", test->frequency_std);
    if (test->nsensor)
        deck_put_option_number(&w, "SHAPE", test->shape_std);
    deck_put(&w, "\n** the frequencies that are measured%s; expected are\n** *MODES\n",
             job->units.frequency > 0 && job->units.frequency != 1 ? ", in the unit of this deck" : " [Hz]");
    for (int k = 0; k < test->modes; k++) {
        deck_put(&w, "** %d, ", test->number[k]);
        if (test->hz)
            deck_put(&w, "%.6g", test->hz[k] / (job->units.frequency > 0 ? job->units.frequency : 1));
        deck_put(&w, "\n");
    }
    put_sensors(&w, test);
    *text = w.status ? NULL : w.text;
    return w.status;
}

/* ------------------------------------------------------------------------------------------------ the user's text */

/* A card with all lines up to the next one, comments among them. */
struct part {
    const char *text, *file; /* file: that it stands in */
    size_t length;
    const struct deck_card *card; /* NULL: not known, and what stands before the first card */
    int include, inside;          /* an *INCLUDE; behind it the parts of its file, so many */
};

struct folder;

struct edit {
    struct deck_writer w;
    const struct folder *to; /* of the file that is written; NULL: paths stay */
    int npart;
    size_t room;
    struct part *part;
};

static size_t line_length(const char *line)
{
    size_t length = strcspn(line, "\n");
    return length + (line[length] == '\n');
}

/* The first asterisk of a line that begins a card, or NULL. */
static const char *begins_card(const char *line)
{
    line += strspn(line, " \t\r\v\f");
    return line[0] == '*' && line[1] != '*' ? line : NULL;
}

static void name_of_card(const char *star, char name[32])
{
    size_t count = 0;
    star += 1 + strspn(star + 1, " \t");
    for (; count + 1 < 32 && (isalnum((unsigned char)*star) || *star == '_'); star++)
        name[count++] = (char)toupper((unsigned char)*star);
    name[count] = 0;
}

/* The value of an option of a part: where it begins, and its length; NULL: the card has none of that name. */
static const char *find_option(const struct part *part, const char *name, size_t *length)
{
    const char *line = part->text, *stop = part->text + part->length;
    for (int continues = 1; continues && line < stop; line += line_length(line)) {
        const char *end = line + strcspn(line, "\n"), *begin = line + strspn(line, " \t");
        for (const char *c = begin + (line == part->text); c + 1 < end; c++)
            end = c[0] == '*' && c[1] == '*' ? c : end;
        while (end > begin && isspace((unsigned char)end[-1]))
            end--;
        if (begin >= end)
            continue;
        continues = end[-1] == ',';
        while (begin < end) {
            const char *comma = memchr(begin, ',', (size_t)(end - begin)), *last = comma ? comma : end,
                       *equals = memchr(begin, '=', (size_t)(last - begin)), *key = equals;
            while (key && key > begin && isspace((unsigned char)key[-1]))
                key--;
            while (begin < last && isspace((unsigned char)*begin))
                begin++;
            if (equals && (size_t)(key - begin) == strlen(name) && !strncasecmp(begin, name, strlen(name))) {
                for (equals++; equals < last && isspace((unsigned char)*equals);)
                    equals++;
                while (last > equals && isspace((unsigned char)last[-1]))
                    last--;
                *length = (size_t)(last - equals);
                return equals;
            }
            begin = last + 1;
        }
    }
    return NULL;
}

/* A path as a file names it, seen from where the program runs. */
static const char *path_from(struct pool *pool, const char *file, const char *path, size_t length)
{
    const char *slash = strrchr(file, '/');
    return *path == '/' || !slash ? pool_format(pool, "%.*s", (int)length, path)
                                  : pool_format(pool, "%.*s/%.*s", (int)(slash - file), file, (int)length, path);
}

/* The folder of a file, and by its numbers whether two are the same one. 0, or 1 where there is none, or memory is out. */
struct folder {
    const char *path; /* absolute */
    struct stat about;
};

static int find_folder(struct pool *pool, const char *file, struct folder *folder)
{
    char here[4096] = ""; /* PATH_MAX of Linux; a longer one is refused */
    const char *slash = strrchr(file, '/');
    int count = slash ? (int)(slash - file) : 0;
    if (*file != '/' && !getcwd(here, sizeof here))
        return 1;
    folder->path = pool_format(pool, "%s%s%.*s", here, *file != '/' && count ? "/" : "", count, file);
    return !folder->path || stat(*folder->path ? folder->path : "/", &folder->about) != 0;
}

static int is_same_folder(const struct folder *a, const struct folder *b)
{
    return a->about.st_dev == b->about.st_dev && a->about.st_ino == b->about.st_ino;
}

/* The text of a file of a deck; NULL where it is no plain file, holds zeros, or memory is out. */
static const char *read_text(struct pool *pool, const char *path)
{
    struct stat about;
    FILE *file = path ? file_open_regular(path, &about) : NULL;
    size_t length = file && about.st_size >= 0 && about.st_size <= DECK_MOST_BYTES ? (size_t)about.st_size : 0;
    char *text = file ? pool_get(pool, length + 1, 1) : NULL;
    if (text && (fread(text, 1, length, file) != length || strlen(text) != length))
        text = NULL;
    if (file)
        (void)fclose(file);
    return text && !strncmp(text, "\xef\xbb\xbf", 3) ? text + 3 : text;
}

/* The parts of a text, and behind each *INCLUDE those of its file. Of what the reader of decks refuses any parts. */
static void gather(struct edit *e, const char *text, const char *file, int depth)
{
    for (const char *end = text; *text && !e->w.status; text = end) {
        struct part part = {.text = text, .file = file};
        const char *star = begins_card(text);
        char name[32] = "";
        if (star)
            name_of_card(star, name);
        do
            end += line_length(end);
        while (*end && !begins_card(end));
        part.length = (size_t)(end - text);
        part.card = deck_card_find(name);
        part.include = !strcmp(name, "INCLUDE");
        struct part *grown = pool_grow(e->w.pool, e->part, (size_t)e->npart, &e->room, sizeof *grown);
        if (!grown) {
            e->w.status = ROTID_ERROR_MEMORY;
            return;
        }
        e->part = grown;
        e->part[e->npart++] = part;
        if (!part.include)
            continue;
        int at = e->npart - 1;
        size_t length;
        const char *value = find_option(&part, "FILE", &length), *path = value ? path_from(e->w.pool, file, value, length) : NULL,
                   *inside = depth < DECK_MOST_INCLUDES ? read_text(e->w.pool, path) : NULL;
        if (inside)
            gather(e, inside, path, depth + 1);
        else
            e->w.status = e->w.pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_ERROR_IO;
        e->part[at].inside = e->npart - 1 - at;
    }
}

static int is_of_state(const struct part *part)
{
    return part->card && part->card->states == CARD_OF_STATE;
}

static int is_state(const struct part *part)
{
    return part->card && !strcmp(part->card->name, "STATE");
}

/* A part as it is, but for a relative path where the text goes to another folder. with: 1 the card, 2 its comments, 3 both */
static void put_part(struct edit *e, const struct part *part, int with)
{
    size_t length = 0;
    const char *text = part->text, *path = e->to ? find_option(part, "FILE", &length) : NULL;
    struct folder folder = {.path = NULL};
    int moves = path && *path != '/';
    if (moves && find_folder(e->w.pool, part->file, &folder))
        e->w.status = e->w.pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_ERROR_IO;
    else if (moves)
        moves = !is_same_folder(&folder, e->to);
    for (const char *line = text, *end = text + part->length; line < end; line += line_length(line)) {
        size_t count = line_length(line), first = strspn(line, " \t");
        int comment = line[first] == '*' && line[first + 1] == '*';
        if (!(with & (comment ? 2 : 1)))
            continue;
        if (moves && path >= line && path < line + count)
            deck_put(&e->w, "%.*s%s/%.*s", (int)(path - line), line, folder.path, (int)(line + count - path), path);
        else
            deck_put(&e->w, "%.*s", (int)count, line);
        if (line[count - 1] != '\n')
            deck_put(&e->w, "\n");
    }
}

/* A deck without states: what is common in its order; a file that is included stays one unless it holds what was measured. */
static void put_common(struct edit *e)
{
    for (int i = 0; i < e->npart; i++) {
        int divided = 0;
        for (int k = 1; k <= e->part[i].inside; k++)
            divided |= is_of_state(&e->part[i + k]);
        if (!is_of_state(&e->part[i]))
            put_part(e, &e->part[i], divided ? 2 : 3);
        i += divided ? 0 : e->part[i].inside;
    }
}

static void put_measured(struct edit *e)
{
    for (int i = 0; i < e->npart; i++)
        if (is_of_state(&e->part[i]))
            put_part(e, &e->part[i], 3);
}

static void put_all(struct edit *e)
{
    for (int i = 0; i < e->npart; i += 1 + e->part[i].inside)
        put_part(e, &e->part[i], 3);
}

static int is_called(struct edit *e, const struct part *part, const char *name)
{
    size_t length = 0;
    const char *value = is_state(part) ? find_option(part, "NAME", &length) : NULL,
               *own = value ? pool_format(e->w.pool, "%.*s", (int)length, value) : "";
    return value && own && same_text(own, name);
}

/* The cards of that state of the deck but for what was measured, and without comments. */
static void put_cards_of(struct edit *e, const char *name)
{
    int inside = 0;
    for (int i = 0; i < e->npart; i++) {
        const struct part *part = &e->part[i];
        if (is_state(part))
            inside = is_called(e, part, name);
        else if (inside && part->card && !is_of_state(part) && strcmp(part->card->name, "NOISE") != 0 &&
                 strcmp(part->card->name, "SENSORS") != 0)
            put_part(e, part, 1);
    }
}

/* The name, or with a number behind it, that no state of the deck has. */
static const char *free_name(struct edit *e, const char *name)
{
    const char *own = name;
    for (int i = 0, n = 1; i < e->npart && own; i++)
        if (is_called(e, &e->part[i], own)) {
            own = pool_format(e->w.pool, "%s_%d", name, ++n);
            i = -1;
        }
    return own;
}

int deck_add_state(struct pool *pool, const char *path, const char *deck, const char *to, const char *home, const char *state,
                   char **text)
{
    static const char begin[] = "*STATE, NAME=";
    struct folder folder;
    struct edit e = {.w.pool = pool, .to = to ? &folder : NULL};
    int states = 0;
    *text = NULL;
    deck = deck ? deck : read_text(pool, path);
    if (!deck || (to && find_folder(pool, to, &folder)))
        return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_ERROR_IO;
    gather(&e, deck, path, 0);
    for (int i = 0; i < e.npart; i++)
        states |= is_state(&e.part[i]);
    const char *card = strstr(state, begin), *name = card ? card + sizeof begin - 1 : "", *rest = name + strcspn(name, "\n");
    name = pool_format(pool, "%.*s", (int)(rest - name), name);
    name = name ? free_name(&e, name) : NULL;
    if (!card || !name)
        return card ? ROTID_ERROR_MEMORY : ROTID_ERROR_ARGUMENT;
    if (states) {
        put_all(&e);
    } else {
        put_common(&e);
        deck_put(&e.w, "*STATE, NAME=measured\n");
        put_measured(&e);
    }
    deck_put(&e.w, "%.*s%s%s\n", (int)(card - state), state, begin, name);
    if (states && home)
        put_cards_of(&e, home);
    deck_put(&e.w, "%s", rest + (*rest == '\n'));
    *text = e.w.status ? NULL : e.w.text;
    return e.w.status;
}

/* ------------------------------------------------------------------------------------------------ read back */

/* The text with the expected frequencies, which stand in comments, in the place of those that are to be measured. */
static const char *filled_in(struct pool *pool, const char *text)
{
    static const char modes[] = "** *MODES\n";
    struct deck_writer w = {.pool = pool};
    const char *begin = NULL;
    for (const char *next = text; (next = strstr(next, modes)); next++)
        begin = next;
    if (!begin)
        return NULL;
    deck_put(&w, "%.*s*MODES\n", (int)(begin - text), text);
    for (begin += sizeof modes - 1; !strncmp(begin, "** ", 3) && isdigit((unsigned char)begin[3]); begin += line_length(begin))
        deck_put(&w, "%.*s", (int)line_length(begin) - 3, begin + 3);
    deck_put(&w, "%s", begin);
    return w.status ? NULL : w.text;
}

/* Whether two jobs are written alike. Names of unknowns have that of their state in front where there are several. */
static int is_same(struct pool *pool, const struct job *a, const struct job *b)
{
    const struct job *job[] = {a, b};
    char *text[2] = {NULL, NULL};
    for (int i = 0; i < 2; i++) {
        struct job own = *job[i];
        int n = own.unknowns.nparameter;
        rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, n);
        for (int p = 0; p < n && bounds; p++) {
            const char *colon = strchr(own.unknowns.bounds[p].name, ':');
            bounds[p] = own.unknowns.bounds[p];
            bounds[p].name = colon ? colon + 1 : bounds[p].name;
        }
        own.unknowns.bounds = bounds;
        if (!bounds || deck_write(pool, &own, NULL, &text[i]))
            return 0;
    }
    return !strcmp(text[0], text[1]);
}

static int is_near(double a, double b)
{
    return fabs(a - b) <= 1e-9 * fabs(b);
}

static int is_at(const struct rotor *rotor, double z, double wanted)
{
    return fabs(z - wanted) <= 1e-9 * rotor_length(rotor);
}

/* The stiffness of a support: the start of an unknown, or as the rotor has it. */
static double stiffness_of(const struct job *job, enum parameter_kind kind, int spring)
{
    for (int p = 0; p < job->unknowns.nparameter; p++)
        if (job->unknowns.parameter[p].kind == kind && job->unknowns.parameter[p].index == spring)
            return job->unknowns.bounds[p].start;
    return kind == PARAMETER_SPRING_K ? job->rotor.spring[spring].lateral : job->rotor.spring[spring].rotational;
}

/* Whether a support is `factor` times as stiff as it was. */
static int is_as_stiff(const struct job *job, int spring, const struct spring *was, double factor)
{
    return is_near(stiffness_of(job, PARAMETER_SPRING_K, spring), was->lateral * factor) &&
           is_near(stiffness_of(job, PARAMETER_SPRING_K_ROT, spring), was->rotational * factor);
}

/* The springs of a state beside those of the state that it is made like: one that moves is hardly there, and there is another. */
static int has_springs(const struct job *job, const struct rotor *like, const rotid_suggested_test *test)
{
    const struct rotor *rotor = &job->rotor;
    int moves = !strcmp(test->id, test_id(TEST_MOVED)), moved = 0, last = rotor->nspring - 1;
    double stiff = !strcmp(test->id, test_id(TEST_STIFF)) ? TEST_STIFFER : 1, soft = TEST_SOFTER;
    int changes = stiff > 1 || !strcmp(test->id, test_id(TEST_FREE));
    if (rotor->nspring != like->nspring + moves)
        return 0;
    for (int s = 0; s < like->nspring; s++) {
        const struct spring *was = &like->spring[s];
        if (rotor->spring[s].position != was->position)
            return 0;
        if (moves && !moved && is_as_stiff(job, s, was, soft * soft) && is_as_stiff(job, last, was, 1) &&
            is_at(rotor, rotor->spring[last].position, test->z_m))
            moved = 1;
        else if (changes && !is_as_stiff(job, s, was, stiff > 1 ? stiff : soft))
            return 0;
        else if (!changes && (rotor->spring[s].lateral != was->lateral || rotor->spring[s].rotational != was->rotational))
            return 0;
    }
    return moved == moves;
}

/* Whether the job is that of a state `like` it with what the test changes. */
static int is_test(struct pool *pool, const struct job *job, const struct job *like, const rotid_suggested_test *test)
{
    struct job expected = *like, own = *job;
    const struct rotor *rotor = &job->rotor;
    int mass = isfinite(test->mass_kg);
    if (test->nsensors_m && rotor->nsensor != test->nsensors_m)
        return 0;
    for (int s = 0; s < test->nsensors_m; s++)
        if (!is_at(rotor, rotor->sensor[s].position, test->sensors_m[s]))
            return 0;
    if (rotor->ndisk != like->rotor.ndisk + mass || !has_springs(job, &like->rotor, test))
        return 0;
    if (mass && (!is_near(rotor->disk[rotor->ndisk - 1].mass, test->mass_kg) ||
                 !is_at(rotor, rotor->disk[rotor->ndisk - 1].position, test->z_m)))
        return 0;
    /* that has been compared; measurements and unknowns are those of the test, and so is the mesh that follows from them */
    expected.measurement = own.measurement;
    expected.unknowns = own.unknowns = (struct job_unknowns){.nparameter = 0};
    expected.rotor.nsensor = rotor->nsensor;
    expected.rotor.sensor = rotor->sensor;
    expected.rotor.nspring = rotor->nspring;
    expected.rotor.spring = rotor->spring;
    own.rotor.ndisk -= mass;
    if (like->rotor.nsegment != rotor->nsegment)
        return 0;
    expected.rotor.segment = POOL_ARRAY(pool, struct segment, rotor->nsegment);
    for (int s = 0; s < rotor->nsegment && expected.rotor.segment; s++) {
        expected.rotor.segment[s] = like->rotor.segment[s];
        expected.rotor.segment[s].elements = rotor->segment[s].elements;
    }
    return expected.rotor.segment && is_same(pool, &own, &expected);
}

/* Errors, which go to the list, where the text does not read as the states of the deck and one of the test more. */
static int read_back(struct pool *pool, const char *from, const char *to, const char *home, const rotid_suggested_test *test,
                     const char *text, struct message_list *notes)
{
    struct message_list warnings;
    struct states given, states;
    const char *filled = filled_in(pool, text), *slash = strrchr(to, '/');
    const struct deck_memory memory = {.name = to,
                                       .text = filled,
                                       .length = filled ? strlen(filled) : 0,
                                       .directory =
                                           slash ? pool_format(pool, "%.*s", slash > to ? (int)(slash - to) : 1, to) : "."};
    message_open(&warnings, pool);
    if (!filled || !memory.directory)
        return ROTID_ERROR_MEMORY;
    int status = deck_read_states(pool, from, NULL, 0, NULL, &warnings, &given);
    if (!status)
        status = deck_read_states(pool, to, &memory, 0, NULL, &warnings, &states);
    for (size_t i = 0; i < warnings.count && status; i++)
        if (warnings.item[i].severity == SEVERITY_ERROR)
            message_add(notes, SEVERITY_ERROR, warnings.item[i].file, warnings.item[i].line, warnings.item[i].column, "%s",
                        warnings.item[i].text);
    if (status)
        return status;
    if (states.nstate != given.nstate + 1) {
        message_add(notes, SEVERITY_ERROR, from, 1, 1, "the state of the test is not read, expected a deck without *FIT, STATE=");
        return ROTID_ERROR_SYNTAX;
    }
    const struct job *like = &given.state->job;
    for (int s = 0; s < given.nstate; s++) {
        like = home && given.state[s].name && same_text(home, given.state[s].name) ? &given.state[s].job : like;
        if (!is_same(pool, &given.state[s].job, &states.state[s].job))
            message_add(notes, SEVERITY_ERROR, from, 1, 1, "state %s would be read as something else in %s",
                        given.state[s].name ? given.state[s].name : "measured", to);
    }
    if (!is_test(pool, &states.state[given.nstate].job, like, test))
        message_add(notes, SEVERITY_ERROR, from, 1, 1, "the cards of the test %s would be read as another one in %s", test->id,
                    to);
    return notes->errors ? ROTID_ERROR_SYNTAX : ROTID_OK;
}

int deck_propose(struct pool *pool, const char *from, const char *to, const char *home, const rotid_suggested_test *test,
                 struct message_list *notes, char **text)
{
    int status = deck_add_state(pool, from, NULL, to, home, test->cards, text);
    if (!status)
        status = read_back(pool, from, to, home, test, *text, notes);
    if (status)
        *text = NULL;
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : status;
}
