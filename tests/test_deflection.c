/* Deflection of tie rods and bars, beside motions that every element follows exactly. */
#include "support.h"

#include "json_deck.h"
#include "model/model.h"
#include "run/run.h"

#define STEEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define SHAFT                                                                                                                    \
    STEEL "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0, 6\n*SHAFT, NAME=core, MATERIAL=steel\n0.4, 0.1, 0.02, 8\n"           \
          "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.05, 0, 6\n"
#define MEMBERS                                                                                                                  \
    SHAFT "*TIEROD, NAME=rods, MATERIAL=steel, FROM=core.start, TO=core.end\n6, 0.008, 0.035, 1e3, 3\n"                          \
          "*TIEROD, NAME=tube, MATERIAL=steel, FROM=0.1, TO=0.8, MODEL=TUBE\n6, 0.008, 0.035, 1e3\n"                             \
          "*BARS, NAME=cage, MATERIAL=steel, CENTER=0.5, LENGTH=0.3\n12, 0.006, 0.045, 4\n"

/* v and theta = -dv/dz of a + b z + c z^2 at every node: no shear force, so that the elements follow it exactly. */
static void bend(const struct beam *beam, double a, double b, double c, double *u)
{
    const struct mesh *mesh = &beam->mesh;
    for (int i = 0; i < mesh->naxis; i++) {
        u[2 * i] = a + (b + c * mesh->z[i]) * mesh->z[i];
        u[2 * i + 1] = -(b + 2 * c * mesh->z[i]);
    }
    for (int m = 0; m < beam->rotor.ntierod + 2 * beam->rotor.nbars; m++) {
        int half = m - beam->rotor.ntierod;
        const struct chain *chain = half < 0 ? &mesh->tierod[m] : &mesh->bars[half];
        double from = mesh->z[chain->first_end],
               to = half < 0 ? mesh->z[chain->last_end] : from + (half % 2 ? 1 : -1) * beam->rotor.bars[half / 2].length / 2;
        for (int i = 1; i <= chain->count; i++) {
            double z = from + (to - from) * i / chain_elements(chain);
            int node = chain_node(chain, i);
            u[2 * node] = a + (b + c * z) * z;
            u[2 * node + 1] = -(b + 2 * c * z);
        }
    }
}

UNIT_TEST(members_follow_a_motion_that_all_elements_can_follow)
{
    static const double motion[3][3] = {{1, 0, 0}, {0.3, -2, 0}, {-0.2, 0.7, 3}};
    double z[13], v[13];
    struct json_deck deck;
    struct spectrum s;
    json_deck_open(&deck, MEMBERS);
    assert_status(spectrum_compute(&deck.pool, NULL, &deck.job->rotor, 0, NULL, NULL, ROTID_GUYAN, 1, &s), ROTID_OK);
    double *u = POOL_ARRAY(&deck.pool, double, s.model->equations.n);
    for (int m = 0; m < 3; m++) {
        const double *q = motion[m];
        static const double end[3][2] = {{0.3, 0.7}, {0.1, 0.8}, {0.35, 0.65}};
        bend(&s.model->discrete.beam, q[0], q[1], q[2], u);
        for (int member = 0; member < 3; member++) {
            discrete_member_deflection(&s.model->discrete, member, u, 13, z, v);
            assert_close(z[0], end[member][0], 1e-12, 0);
            assert_close(z[12], end[member][1], 1e-12, 0);
            for (int i = 0; i < 13; i++) {
                assert_true(!i || z[i] > z[i - 1]);
                assert_close(v[i], q[0] + (q[1] + q[2] * z[i]) * z[i], 1e-12, 1e-13);
            }
        }
    }
    json_deck_close(&deck);
}
