#define _GNU_SOURCE /* memfd_create */
#include "fuzz_one.h"

#include <sys/mman.h>
#include <unistd.h>

#include "api/api.h"
#include "deck/deck.h"
#include "import/import.h"
#include "result/result.h"
#include "study/study.h"
#include "uff/uff.h"

static void require(int condition)
{
    if (!condition)
        abort();
}

/* The bytes as a file in memory; the path to open it by to path. Returns its descriptor. */
static int hold(const uint8_t *bytes, size_t count, char path[32])
{
    int descriptor = memfd_create("fuzz", 0);
    require(descriptor >= 0);
    while (count) {
        ssize_t written = write(descriptor, bytes, count);
        require(written > 0);
        bytes += written;
        count -= (size_t)written;
    }
    (void)snprintf(path, 32, "/proc/self/fd/%d", descriptor);
    return descriptor;
}

static int read_values(struct uff_reader *reader)
{
    enum { MOST = 7 };
    struct uff_function function;
    double x[MOST], real[MOST], imag[MOST];
    long long got = 0, total = 0;
    int status = uff_read_function(reader, &function);
    do {
        if (status == ROTID_OK)
            status = uff_read_values(reader, MOST, x, real, imag, &got);
        require(got >= 0 && got <= MOST);
        total += got;
    } while (status == ROTID_OK && got);
    require(status != ROTID_OK || total == function.count);
    return status;
}

static int read_set(struct uff_reader *reader, struct pool *pool, int number)
{
    struct uff_header header;
    struct uff_units units;
    struct uff_node *node;
    struct uff_shape shape;
    int count;
    switch (number) {
    case 15:
    case 781:
    case 2411:
        return uff_read_nodes(reader, pool, &count, &node);
    case 55:
        return uff_read_shape_set(reader, pool, &shape);
    case 58:
        return read_values(reader);
    case 151:
        return uff_read_header(reader, &header);
    case 164:
        return uff_read_units(reader, &units);
    default:
        return ROTID_OK;
    }
}

/* All sets in turn; every third is only read over. */
static void read_sets(struct pool *pool, const char *path, size_t most)
{
    struct message_list messages;
    struct uff_reader *reader;
    struct uff_set set, first = {0};
    message_open(&messages, pool);
    require(uff_open(pool, path, &messages, &reader) == ROTID_OK);
    size_t count = 0;
    for (int status = ROTID_OK; status != UFF_END; ++count) {
        int errors = messages.errors;
        require(count <= most + 2);
        status = uff_next(reader, &set);
        if (status == ROTID_OK && !first.number)
            first = set;
        if (status == ROTID_OK && count % 3 != 2)
            status = read_set(reader, pool, set.number);
        require(status == ROTID_OK || status == UFF_END || status == ROTID_ERROR_SYNTAX);
        require((status == ROTID_ERROR_SYNTAX) == (messages.errors > errors));
    }
    if (first.number) {
        require(uff_return_to(reader, &first) == ROTID_OK);
        (void)read_set(reader, pool, first.number);
    }
    uff_close(reader);
}

void fuzz_one_uff(const uint8_t *bytes, size_t count)
{
    char path[32];
    struct pool pool;
    struct message_list messages;
    struct uff_file file;
    int descriptor = hold(bytes, count, path);
    pool_open(&pool, NULL);
    read_sets(&pool, path, count);
    message_open(&messages, &pool);
    int status = uff_read(&pool, path, &messages, &file);
    require(status == ROTID_OK || status == ROTID_ERROR_SYNTAX);
    require((status != ROTID_OK) == (messages.errors > 0));
    pool_close(&pool);
    (void)close(descriptor);
}

void fuzz_one_import(const uint8_t *bytes, size_t count)
{
    const struct measurement_options options = {.threads = 1};
    const struct listing_options keep = {.keep_shapes = 1};
    char path[32];
    struct pool pool;
    struct message_list messages;
    struct listing listing;
    struct measurement measurement;
    const char **summary;
    int lines, descriptor = hold(bytes, count, path);
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    int status = listing_read(&pool, path, &keep, &messages, &listing);
    require(status == ROTID_OK || (status == ROTID_ERROR_SYNTAX && messages.errors));
    if (!status)
        require(listing_summarise(&pool, &listing, &lines, &summary) == ROTID_OK);
    message_open(&messages, &pool);
    status = measurement_read(&pool, path, &options, &messages, &measurement);
    require(status == ROTID_OK || status == ROTID_ERROR_SYNTAX || status == ROTID_ERROR_ARGUMENT);
    require((status != ROTID_OK) == (messages.errors > 0));
    pool_close(&pool);
    (void)close(descriptor);
}

void fuzz_one_deck(const uint8_t *bytes, size_t count)
{
    char path[32];
    struct pool pool;
    struct message_list messages;
    struct states states;
    char *text;
    int descriptor = hold(bytes, count, path);
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    int status = deck_read_states(&pool, path, NULL, 0, NULL, &messages, &states);
    require((status != ROTID_OK) == (messages.errors > 0));
    if (!status) { /* what a deck cannot say is an argument that it refuses */
        int written = deck_write(&pool, &states, &states, NULL, &messages, &text);
        require(written == ROTID_OK || written == ROTID_ERROR_ARGUMENT);
        require((written == ROTID_OK) == (text != NULL));
    }
    pool_close(&pool);
    (void)close(descriptor);
}

void fuzz_one_table(const uint8_t *bytes, size_t count)
{
    static const char *const card[] = {"*SHAFT, MATERIAL=steel",
                                       "*SHAFT, NAME=core, MATERIAL=steel",
                                       "*BEAM, MATERIAL=steel",
                                       "*MODES",
                                       "*SENSORS",
                                       "*SHAPE",
                                       "*SHAPE, MODE=1",
                                       "*FREQUENCIES"};
    char path[32], text[512];
    int descriptor = hold(bytes, count, path);
    for (size_t i = 0, cards = sizeof card / sizeof *card; i < 2 * cards; i++) {
        const char *named = card[i % cards];
        struct pool pool;
        struct message_list messages;
        struct states states;
        pool_open(&pool, NULL);
        message_open(&messages, &pool);
        (void)snprintf(text, sizeof text, "%s*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n%s%s%s, FILE=%s\n",
                       i >= cards ? "*UNITS, LENGTH=IN, FREQUENCY=RPM\n" : "",
                       i % cards > 2 ? "*SHAFT, NAME=first, MATERIAL=steel\n1, 0.1, 0, 20\n" : "",
                       i % cards > 4 ? "*MODES\n1, 500\n2, 1300\n*SENSORS\n1, 0\n2, 0.5\n3, 1\n" : "", named, path);
        struct deck_memory memory = {"deck", strlen(text), text, "/"};
        int status = deck_read_states(&pool, "deck", &memory, 0, NULL, &messages, &states);
        require((status != ROTID_OK) == (messages.errors > 0));
        pool_close(&pool);
    }
    (void)close(descriptor);
}

/* Ends what an input would take minutes for, at a point that the bytes choose. */
static int ends_after(void *left)
{
    int *polls = left;
    return --*polls < 0;
}

static int is_small(const rotid_deck *deck)
{
    const struct states *states = deck_states_of(deck);
    int elements = 0, modes = 0;
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        modes += job->measurement.nmode + job->rotor.nsensor;
        elements += job->options.solid ? 1000 : 0;
        for (int i = 0; i < job->rotor.nsegment; i++)
            elements += job->rotor.segment[i].elements;
        for (int i = 0; i < job->rotor.ntierod; i++)
            elements += job->rotor.tierod[i].elements;
        for (int i = 0; i < job->rotor.nbars; i++)
            elements += job->rotor.bars[i].elements;
    }
    return elements < 100 && modes < 40;
}

void fuzz_one_suggest(const uint8_t *bytes, size_t count)
{
    enum { OPTIONS = 9 };
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck = NULL;
    rotid_suggestion *found = NULL;
    if (count < OPTIONS)
        return;
    const rotid_suggest_options options = {.size = sizeof options,
                                           .wanted_percent = bytes[0] / 16.0,
                                           .frequency_noise = bytes[1] * bytes[1] * 1e-6,
                                           .shape_noise = bytes[2] * 1e-3,
                                           .set_up_cost = bytes[3],
                                           .sensors = bytes[4] % 40,
                                           .modes = bytes[5] % 25,
                                           .seed = bytes[7]};
    int polls = bytes[8];
    const rotid_environment environment = {.size = sizeof environment, .cancelled = ends_after, .context = &polls};
    int status =
        rotid_deck_read_text(count - OPTIONS, (const char *)bytes + OPTIONS, "deck", NULL, 0, NULL, NULL, failure, &deck);
    require(status == ROTID_OK || *failure || deck);
    if (!status && is_small(deck)) {
        status = rotid_suggest(deck, &options, &environment, failure, &found);
        require((status == ROTID_OK) == (found != NULL));
        require(status >= 0 || *failure);
        rotid_suggestion_free(found);
    }
    rotid_deck_free(deck);
}

void fuzz_one_plan(const uint8_t *bytes, size_t count)
{
    struct pool pool;
    struct message_list messages;
    struct plan plan;
    char path[32];
    int descriptor = hold(bytes, count, path);
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    int status = plan_read(&pool, path, &messages, &plan);
    require((status == ROTID_OK) == (messages.errors == 0));
    for (int axis = 0; axis < PLAN_AXES; axis++)
        require(status != ROTID_OK || plan.axis[axis].count > 0);
    require(status != ROTID_OK || plan.replicates > 0);
    (void)plan_is(path);
    pool_close(&pool);
    (void)close(descriptor);
}

/* The lines behind the first with the stamps of it: what is beyond a digest would not be reached otherwise. NULL where there are
 * none to be had; to be freed. */
static char *stamp_all(struct pool *pool, const uint8_t *bytes, size_t count)
{
    char *text = calloc(1, count + 1), *all = NULL, study[DIGEST_LETTERS + 1];
    struct study_header header;
    size_t length;
    require(text != NULL);
    memcpy(text, bytes, count);
    char *end = strchr(text, '\n');
    if (end && !results_header_read(pool, text, (size_t)(end - text), &header)) {
        FILE *stream = open_memstream(&all, &length);
        require(stream != NULL);
        stamp_study(&header, study);
        (void)fprintf(stream, "%.*s\n", (int)(end - text), text);
        for (char *line = end + 1; (end = strchr(line, '\n')); line = end + 1) {
            char *bare = end - line > 1 && end[-1] == '}' ? strndup(line, (size_t)(end - line) + 1) : NULL,
                 *stamped = bare ? stamp_line(study, bare) : NULL;
            (void)fprintf(stream, "%.*s", stamped ? (int)strlen(stamped) : (int)(end - line) + 1, stamped ? stamped : line);
            free(stamped);
            free(bare);
        }
        require(fclose(stream) == 0);
    }
    free(text);
    return all;
}

static void read_results(const uint8_t *bytes, size_t count)
{
    struct pool pool;
    struct message_list messages;
    struct study_result summary;
    struct study_header header;
    char path[32];
    int descriptor = hold(bytes, count, path);
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    struct table *runs = table_open(&pool, "");
    int status = summary_read(&pool, path, &messages, &header, runs, &summary);
    require((status == ROTID_OK) == (messages.errors == 0));
    if (status == ROTID_OK) {
        const struct result result = {
            .head = {.rotid = "0", .commit = "0", .blas = "", .seed = 1, .threads = 1, .command = "study"}, .study = &summary};
        char *text = result_json(&result);
        FILE *nowhere = fopen("/dev/null", "wb");
        require(text && nowhere);
        screen_study(&(struct screen){nowhere, &pool, 0, SCREEN_WIDTH}, &summary);
        table_write_csv(nowhere, runs);
        (void)fclose(nowhere);
        free(text);
    }
    pool_close(&pool);
    (void)close(descriptor);
}

void fuzz_one_results(const uint8_t *bytes, size_t count)
{
    struct pool pool;
    pool_open(&pool, NULL);
    char *stamped = stamp_all(&pool, bytes, count);
    read_results(bytes, count);
    if (stamped)
        read_results((const uint8_t *)stamped, strlen(stamped));
    free(stamped);
    pool_close(&pool);
}
