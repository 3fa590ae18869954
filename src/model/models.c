#include "model/model.h"

#include <pthread.h>

struct built_model {
    struct built_model *next;
    const struct models *owner;
    struct rotor rotor; /* as it was given */
    int refine, nrigid;
    struct discrete discrete; /* only what does not depend on values is used */
};

struct near {
    struct near *next;
    int n, count;
    const double *phi;
};

struct models {
    struct pool pool;
    pthread_mutex_t lock; /* of the pool and the list */
    enum discretisation as;
    int takes_up;
    const struct models *older;
    struct models *solids; /* of the same run */
    struct built_model *first;
    struct near *near; /* the newest first */
};

/* Causes have no part in the mesh of a solid. */
static int share_mesh(enum discretisation as, const struct rotor *built, const struct rotor *asked)
{
    struct rotor a = *built, b = *asked;
    if (discretisation_is_solid(as))
        a.neffect = b.neffect = 0;
    return rotor_same_shape(&a, &b);
}

/* The entry with this mesh, if possible with these values. */
static struct built_model *find(const struct models *models, const struct rotor *rotor, int refine, int *same_values)
{
    struct built_model *found = NULL;
    *same_values = 0;
    for (; models; models = models->older)
        for (struct built_model *e = models->first; e; e = e->next)
            if (e->refine == refine && share_mesh(models->as, &e->rotor, rotor)) {
                *same_values = rotor_same_shape(&e->rotor, rotor) && rotor_same_values(&e->rotor, rotor);
                found = e;
                if (*same_values)
                    return e;
            }
    return found;
}

/* What has been counted with any mesh, -1: nothing. Of a solid, where counting costs as much as its modes, whatever causes are in
 * the rotor, which make no suspension of a bending mode. */
static int counted(const struct models *models, const struct rotor *rotor)
{
    for (; models; models = models->older)
        for (const struct built_model *e = models->first; e; e = e->next) {
            struct rotor known = e->rotor, asked = *rotor;
            if (discretisation_is_solid(models->as))
                known.neffect = asked.neffect = 0;
            if (e->nrigid >= 0 && rotor_same_shape(&known, &asked) && rotor_same_values(&known, &asked))
                return e->nrigid;
        }
    return -1;
}

static int add(struct models *models, const struct rotor *rotor, int refine, const struct built_model *built,
               struct built_model **added, int *failed)
{
    struct built_model *e = POOL_NEW(&models->pool, struct built_model);
    int status = e ? rotor_copy(&models->pool, rotor, &e->rotor) : ROTID_ERROR_MEMORY;
    if (!status && built)
        e->discrete = built->discrete;
    else if (!status)
        status = discrete_build(&models->pool, models->as, rotor, 0, NULL, refine, &e->discrete, failed);
    if (status)
        return status;
    e->rotor.nspring = rotor->nspring; /* without those of the sling */
    e->owner = models;
    e->refine = refine;
    e->nrigid = -1;
    e->next = models->first;
    models->first = *added = e;
    return ROTID_OK;
}

static struct models *models_new(struct pool *pool, enum discretisation as, const struct models *older)
{
    struct models *models = POOL_NEW(pool, struct models);
    if (!models || pthread_mutex_init(&models->lock, NULL))
        return NULL;
    models->as = as;
    models->older = older;
    models->takes_up = 1;
    pool_open(&models->pool, pool->allocator);
    return models;
}

struct models *models_as(struct pool *pool, enum discretisation as)
{
    struct models *models = models_new(pool, as, NULL);
    if (models)
        models_end_run(pool, models, NULL);
    return models;
}

enum discretisation models_discretisation(const struct models *models)
{
    return models ? models->as : AS_BEAM;
}

int models_begin(struct pool *pool, enum discretisation as, const struct rotor *rotor, struct models **models,
                 struct model_size *size, int *failed)
{
    struct built_model *e;
    *failed = -1;
    *models = models_new(pool, as, NULL);
    int status = *models ? add(*models, rotor, 1, NULL, &e, failed) : ROTID_ERROR_MEMORY;
    if (*models)
        models_end_run(pool, *models, NULL);
    if (status)
        return status;
    rotid_matrix structure;
    int *sensor_dof = POOL_ARRAY(pool, int, rotor->nsensor);
    if (!sensor_dof)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < rotor->nsensor; s++)
        sensor_dof[s] = discrete_sensor_dof(&e->discrete, s);
    discrete_structure(&e->discrete, &structure);
    *size = (struct model_size){structure.n, sensor_dof};
    return ROTID_OK;
}

struct models *models_for_run(struct pool *pool, struct models *given)
{
    if (given && given->takes_up)
        return given;
    struct models *models = models_new(pool, models_discretisation(given), given);
    if (!models || models->as == AS_SOLID)
        return models;
    models->solids = models_new(pool, AS_SOLID, NULL);
    return models->solids ? models : NULL;
}

struct models *models_solids(struct models *models)
{
    return models && models->as != AS_SOLID ? models->solids : models;
}

void models_end_run(struct pool *pool, struct models *models, const struct models *given)
{
    if (models == given)
        return;
    if (models->solids)
        models_end_run(pool, models->solids, NULL);
    models->takes_up = 0;
    (void)pthread_mutex_destroy(&models->lock);
    pool_absorb(pool, &models->pool);
}

int models_discretise(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                      const struct parameter *parameter, int refine, struct discrete *discrete, int *nrigid, int *failed)
{
    int same_values, status = ROTID_OK, takes_up = models && models->takes_up;
    *failed = -1;
    if (takes_up)
        (void)pthread_mutex_lock(&models->lock);
    struct built_model *e = find(models, rotor, refine, &same_values);
    if (takes_up && (!same_values || e->owner != models))
        status = add(models, rotor, refine, e, &e, failed);
    *nrigid = status ? -1 : rotor->settled_rigid ? rotor->settled_rigid - 1 : counted(models, rotor);
    if (takes_up)
        (void)pthread_mutex_unlock(&models->lock);
    if (status)
        return status;
    return e ? discrete_of_shape(pool, &e->discrete, rotor, nparameter, parameter, discrete)
             : discrete_build(pool, models_discretisation(models), rotor, nparameter, parameter, refine, discrete, failed);
}

void models_keep_rigid(struct models *models, const struct rotor *rotor, int refine, int nrigid)
{
    int same_values;
    if (!models || !models->takes_up)
        return;
    (void)pthread_mutex_lock(&models->lock);
    struct built_model *e = find(models, rotor, refine, &same_values);
    if (e && same_values)
        e->nrigid = nrigid;
    (void)pthread_mutex_unlock(&models->lock);
}

static const double *copied(struct pool *pool, int n, const double *from, int *status)
{
    double *copy = from ? POOL_ARRAY(pool, double, n) : NULL;
    if (from && !copy)
        *status = ROTID_ERROR_MEMORY;
    for (int i = 0; i < n && copy; i++)
        copy[i] = from[i];
    return copy;
}

int models_keep_modes(struct models *models, int n, int count, const double *phi)
{
    int known, status = ROTID_OK;
    if (!models || !models->takes_up || (models->as != AS_SOLID && models_modes(models, n, &known) && known >= count))
        return ROTID_OK;
    (void)pthread_mutex_lock(&models->lock);
    struct near *near = POOL_NEW(&models->pool, struct near);
    if (near) {
        *near = (struct near){models->near, n, count, copied(&models->pool, n * count, phi, &status)};
        models->near = status ? models->near : near;
    }
    (void)pthread_mutex_unlock(&models->lock);
    return near ? status : ROTID_ERROR_MEMORY;
}

const double *models_modes(struct models *models, int n, int *count)
{
    const struct near *near = NULL;
    *count = 0;
    if (!models || !models->takes_up)
        return NULL;
    (void)pthread_mutex_lock(&models->lock);
    for (near = models->near; near && near->n != n; near = near->next)
        ;
    (void)pthread_mutex_unlock(&models->lock);
    *count = near ? near->count : 0;
    return near ? near->phi : NULL;
}
