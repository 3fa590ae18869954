#include "diagnose/causes/causes.h"

/* One line a cause, in the order of reports: numbers, measurement chain, physics. Adding a cause: its file, and a line here. */
#define CATALOGUE(X)                                                                                                             \
    X(mesh)                                                                                                                      \
    X(guyan_reduction)                                                                                                           \
    X(sensor_gain)                                                                                                               \
    X(sensor_sign)                                                                                                               \
    X(sensor_swap)                                                                                                               \
    X(sensor_position)                                                                                                           \
    X(sensor_line)                                                                                                               \
    X(duplicate_channel)                                                                                                         \
    X(noise_level)                                                                                                               \
    X(mode_pairing)                                                                                                              \
    X(beam_theory)                                                                                                               \
    X(step_stiffness)                                                                                                            \
    X(stiffness_gradient)                                                                                                        \
    X(stiffness_profile)                                                                                                         \
    X(stiffness_local)                                                                                                           \
    X(joint)                                                                                                                     \
    X(support)                                                                                                                   \
    X(support_position)                                                                                                          \
    X(support_extra)                                                                                                             \
    X(support_rotation)                                                                                                          \
    X(clamp)                                                                                                                     \
    X(added_mass)                                                                                                                \
    X(added_inertia)                                                                                                             \
    X(diameter)                                                                                                                  \
    X(density)                                                                                                                   \
    X(stiffness)                                                                                                                 \
    X(layer_slip)                                                                                                                \
    X(hub_stiffness)                                                                                                             \
    X(tie_stiffness)                                                                                                             \
    X(tie_tension)                                                                                                               \
    X(tie_shear)                                                                                                                 \
    X(shear_coefficient)                                                                                                         \
    X(accelerometer_mass)

#define DECLARE(id) extern const struct cause_kind cause_##id;
CATALOGUE(DECLARE)
#undef DECLARE

static const struct cause_kind *const table[] = {
#define ENTER(id) &cause_##id,
    CATALOGUE(ENTER)
#undef ENTER
};

int catalogue_count(void)
{
    return (int)(sizeof table / sizeof *table);
}

const struct cause_kind *catalogue_item(int i)
{
    return table[i];
}

const struct cause_kind *catalogue_find(const char *id)
{
    for (int i = 0; i < catalogue_count(); i++)
        if (same_text(table[i]->id, id))
            return table[i];
    return NULL;
}

const struct cause_kind *catalogue_of(const struct effect *effect)
{
    for (int i = 0; i < catalogue_count(); i++)
        if (table[i]->effect == effect->kind)
            return table[i];
    return NULL;
}

int correction_apply(struct pool *pool, struct job *job, const struct correction *correction)
{
    const struct cause_kind *cause = catalogue_find(correction->id);
    if (!cause || !cause->correct)
        return ROTID_ERROR_ARGUMENT;
    return cause->correct(pool, job, correction);
}
