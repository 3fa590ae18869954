#include "beam/rotor.h"

double rotor_length(const struct rotor *rotor)
{
    double sum = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        sum += rotor->segment[s].length;
    return sum;
}

void rotor_group_span(const struct rotor *rotor, int group, double *from, double *to)
{
    double z = 0;
    int found = 0;
    *from = *to = 0;
    for (int s = 0; s < rotor->nsegment; s++) {
        if (rotor->segment[s].group == group && !found++)
            *from = z;
        z += rotor->segment[s].length;
        if (rotor->segment[s].group == group)
            *to = z;
    }
}

double material_shear_modulus(const struct material *material)
{
    return material->isotropic ? material->e / (2 * (1 + material->nu)) : material->g;
}
