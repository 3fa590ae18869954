#include "export/ross_saved.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "result/json_file.h"
#include "result/place.h"
#include "rotid.h"

#define MOST_NODES 10000 /* as elements of a deck */

/* What a rotor of ROSS has and one of rotid has not; each is said once. */
enum lost {
    LOST_TORQUE,
    LOST_SHEAR,
    LOST_ROTARY,
    LOST_METHOD,
    LOST_DAMPING,
    LOST_SPEEDS,
    LOST_PLANE,
    LOST_CROSS,
    LOST_MASS,
    LOSSES
};

static const char *const lost_text[LOSSES] = {
    [LOST_TORQUE] = "torque is left out: it does not act on bending at rest here",
    [LOST_SHEAR] = "elements without shear_effects get them: every element of rotid has them",
    [LOST_ROTARY] = "elements without rotary_inertia get it: every element of rotid has it",
    [LOST_METHOD] = "shear coefficients are Cowper's, not those of shear_method_calc",
    [LOST_DAMPING] = "damping is left out",
    [LOST_SPEEDS] = "of bearings with values at several speeds the first one is taken",
    [LOST_PLANE] = "kyy is not kxx: kxx is taken, for bending in the plane x",
    [LOST_CROSS] = "cross coupling (kxy, kyx) is left out",
    [LOST_MASS] = "added masses of bearings (mxx) are left out"};

struct saved_reader {
    struct reader reader;
    struct ross_saved *saved;
    const char *first[LOSSES]; /* the object in which it is lost */
};

static void lose(struct saved_reader *r, enum lost what, const struct json_place *of)
{
    if (!r->first[what])
        r->first[what] = pool_copy_text(r->reader.pool, of->key ? of->key : "");
}

static double number_or(const struct json_place *object, const char *key, double standard)
{
    struct json_place at;
    return place_has(object, key) && place_find(object, key, PLACE_NUMBER, &at) ? at.json->valuedouble : standard;
}

/* A finite number, above `least`, or from it on where `from`. */
static double number_above(const struct json_place *object, const char *key, double least, int from)
{
    struct json_place at;
    if (!place_need(object, key, PLACE_NUMBER, &at))
        return 1;
    double value = at.json->valuedouble;
    if (!isfinite(value) || !(from ? value >= least : value > least))
        place_wrong(&at, "is %g, expected a number %s %g", value, from ? "not below" : "above", least);
    return value;
}

static int node_of(const struct json_place *object, const char *key)
{
    struct json_place at;
    if (!place_need(object, key, PLACE_NUMBER, &at))
        return 0;
    double n = at.json->valuedouble;
    if (!(n >= 0 && n <= MOST_NODES && n == floor(n)))
        place_wrong(&at, "is %g, expected the number of a node from 0 to %d", n, MOST_NODES);
    return n >= 0 && n <= MOST_NODES ? (int)n : 0;
}

static int flag_or(const struct json_place *object, const char *key, int standard)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object->json, key);
    return cJSON_IsBool(value) ? cJSON_IsTrue(value) : standard;
}

static const char *text_or(struct saved_reader *r, const struct json_place *object, const char *key, const char *standard)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object->json, key);
    const char *text = pool_copy_text(r->reader.pool, cJSON_IsString(value) ? value->valuestring : standard);
    return text ? text : "";
}

/* The first number of a list, or the number itself; 0 where there is none. *varies: the list has others. */
static double first_of(const struct json_place *object, const char *key, int *several)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object->json, key),
                *first = cJSON_IsArray(value) ? value->child : value;
    for (const cJSON *v = cJSON_IsArray(value) ? first : NULL; v; v = v->next)
        *several |= v != first;
    return first && cJSON_IsNumber(first) && isfinite(first->valuedouble) ? first->valuedouble : 0;
}

static void *append(struct saved_reader *r, void **list, int *count, size_t *room, size_t size)
{
    char *grown = pool_grow(r->reader.pool, *list, (size_t)*count, room, size);
    if (!grown) {
        r->reader.status = ROTID_ERROR_MEMORY;
        return NULL;
    }
    *list = grown;
    return memset(grown + (size_t)(*count)++ * size, 0, size);
}
#define APPEND(r, list, count, room) append((r), (void **)&(list), &(count), &(room), sizeof *(list))

static void read_material(struct saved_reader *r, const struct json_place *object, struct material *material)
{
    struct json_place at;
    if (!place_need(object, "material", PLACE_OBJECT, &at))
        return;
    material->name = text_or(r, &at, "name", "material");
    material->e = number_above(&at, "E", 0, 0);
    material->rho = number_above(&at, "rho", 0, 0);
    material->g = number_above(&at, "G_s", 0, 0);
    material->nu = material->e / (2 * material->g) - 1;
    material->isotropic = 1;
    if (!(material->nu > -1 && material->nu <= 0.5) && !r->reader.status)
        place_wrong(&at, "has E %g and G_s %g, which is Poisson's ratio %g, expected one above -1 and at most 0.5", material->e,
                    material->g, material->nu);
}

static void read_element(struct saved_reader *r, const struct json_place *object)
{
    static const char *const keys[2][2] = {{"idl", "idr"}, {"odl", "odr"}};
    struct ross_shaft_element *e = APPEND(r, r->saved->element, r->saved->nelement, r->saved->element_room);
    if (!e)
        return;
    e->n = node_of(object, "n");
    e->length = number_above(object, "L", 0, 0);
    for (int end = 0; end < 2; end++) {
        e->inner[end] = number_above(object, keys[0][end], 0, 1);
        e->outer[end] = number_above(object, keys[1][end], 0, 0);
        if (!r->reader.status && e->inner[end] >= e->outer[end])
            place_wrong(object, "has an inner diameter of %g m and an outer one of %g m, expected the inner one below",
                        e->inner[end], e->outer[end]);
    }
    e->force = number_or(object, "axial_force", 0);
    e->tag = text_or(r, object, "tag", "");
    read_material(r, object, &e->material);
    if (number_or(object, "torque", 0) != 0)
        lose(r, LOST_TORQUE, object);
    if (!flag_or(object, "shear_effects", 1))
        lose(r, LOST_SHEAR, object);
    if (!flag_or(object, "rotary_inertia", 1))
        lose(r, LOST_ROTARY, object);
    if (strcmp(text_or(r, object, "shear_method_calc", "cowper"), "cowper") != 0)
        lose(r, LOST_METHOD, object);
    if (number_or(object, "alpha", 0) != 0 || number_or(object, "beta", 0) != 0)
        lose(r, LOST_DAMPING, object);
}

static void read_disk(struct saved_reader *r, const struct json_place *object)
{
    struct ross_disk *d = APPEND(r, r->saved->disk, r->saved->ndisk, r->saved->disk_room);
    if (!d)
        return;
    d->n = node_of(object, "n");
    d->mass = number_above(object, "m", 0, 1);
    d->diametral = place_has(object, "Id") ? number_above(object, "Id", 0, 1) : 0;
    d->polar = place_has(object, "Ip") ? number_above(object, "Ip", 0, 1) : 0;
    d->tag = text_or(r, object, "tag", "disk");
}

static void read_point_mass(struct saved_reader *r, const struct json_place *object)
{
    struct ross_disk *d = APPEND(r, r->saved->disk, r->saved->ndisk, r->saved->disk_room);
    if (!d)
        return;
    d->n = node_of(object, "n");
    d->mass = number_or(object, "mx", NAN);
    d->mass = isnan(d->mass) ? number_above(object, "m", 0, 1) : d->mass;
    d->tag = text_or(r, object, "tag", "mass");
}

static void read_bearing(struct saved_reader *r, const struct json_place *object)
{
    struct ross_bearing *b = APPEND(r, r->saved->bearing, r->saved->nbearing, r->saved->bearing_room);
    int several = 0, others = 0;
    struct json_place at;
    if (!b)
        return;
    b->n = node_of(object, "n");
    b->link = place_has(object, "n_link") && place_find(object, "n_link", PLACE_NUMBER, &at) ? node_of(object, "n_link") : -1;
    b->kxx = first_of(object, "kxx", &several);
    b->tag = text_or(r, object, "tag", "bearing");
    if (!place_has(object, "kxx"))
        place_wrong(object, "has no kxx, expected its stiffness");
    else if (b->kxx < 0)
        place_wrong(object, "has kxx %g, expected a stiffness not below zero", b->kxx);
    if (several)
        lose(r, LOST_SPEEDS, object);
    if (first_of(object, "kyy", &others) != b->kxx)
        lose(r, LOST_PLANE, object);
    if (first_of(object, "kxy", &others) != 0 || first_of(object, "kyx", &others) != 0)
        lose(r, LOST_CROSS, object);
    if (first_of(object, "cxx", &others) != 0 || first_of(object, "cyy", &others) != 0)
        lose(r, LOST_DAMPING, object);
    if (first_of(object, "mxx", &others) != 0 || first_of(object, "myy", &others) != 0)
        lose(r, LOST_MASS, object);
}

/* By the class of ROSS in front of the underscore, or, of one derived from these, by what it holds. */
static void read_object(struct saved_reader *r, const struct json_place *object)
{
    size_t length = strcspn(object->key, "_");
    const cJSON *json = object->json;
    int is_element = length == 12 && !strncmp(object->key, "ShaftElement", length),
        is_mass = length == 9 && !strncmp(object->key, "PointMass", length);
    if (is_element)
        read_element(r, object);
    else if (is_mass)
        read_point_mass(r, object);
    else if (cJSON_GetObjectItemCaseSensitive(json, "kxx"))
        read_bearing(r, object);
    else if (cJSON_GetObjectItemCaseSensitive(json, "Id") && cJSON_GetObjectItemCaseSensitive(json, "m"))
        read_disk(r, object);
    else
        place_wrong(object, "is no part that rotid knows, expected a ShaftElement, a disk, a bearing or a PointMass of ROSS");
}

static int by_node(const void *left, const void *right)
{
    const struct ross_shaft_element *a = left, *b = right;
    return a->n != b->n ? (a->n > b->n) - (a->n < b->n) : (a->inner[0] > b->inner[0]) - (a->inner[0] < b->inner[0]);
}

static void read_root(struct saved_reader *r, const struct json_place *root)
{
    if (!cJSON_IsObject(root->json) || !place_has(root, "parameters")) {
        place_wrong(root, "is no rotor of ROSS, expected what Rotor.save writes into a file .json");
        return;
    }
    r->saved->version = text_or(r, root, "ross_version", "of an unknown version");
    for (const cJSON *json = root->json->child; json; json = json->next) {
        struct json_place object = {.reader = &r->reader, .above = root, .key = json->string, .json = json};
        if (cJSON_IsObject(json) && strcmp(json->string, "parameters") != 0)
            read_object(r, &object);
    }
    if (!r->saved->nelement && !r->reader.status)
        place_wrong(root, "has no ShaftElement, expected at least one");
}

int ross_saved_read(struct pool *pool, const char *path, struct message_list *messages, struct ross_saved *saved)
{
    struct saved_reader r = {.reader = {.pool = pool, .messages = messages, .file = path}, .saved = saved};
    struct json_place root = {.reader = &r.reader};
    cJSON *json;
    int is_lines;
    *saved = (struct ross_saved){.version = ""};
    int status = json_file_read(pool, path, messages, &json, &is_lines);
    if (status)
        return status;
    root.json = json;
    read_root(&r, &root);
    cJSON_Delete(json);
    for (int i = 0; i < LOSSES && !r.reader.status; i++)
        if (r.first[i])
            message_add(messages, SEVERITY_WARNING, NULL, 0, 0, "%s: %s", r.first[i], lost_text[i]);
    if (saved->nelement)
        qsort(saved->element, (size_t)saved->nelement, sizeof *saved->element, by_node);
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : r.reader.status;
}
