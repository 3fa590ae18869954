/* Data at nodes: sets 55 and 2414. */
#include <string.h>

#include "rotid.h"
#include "uff/uff_record.h"
#include "uff/uff_write.h"

enum { NORMAL_MODE = 2, COMPLEX_FIRST_ORDER = 3, COMPLEX_SECOND_ORDER = 7 }; /* analysis type */

static void put_ids(struct uff_put *put, const char (*id)[UFF_TEXT + 1])
{
    for (int i = 0; i < UFF_ID_LINES; ++i)
        uff_put_text_line(put, id[i]);
}

/* Records 7 and 8. The eigenvalue of a complex mode stands there and not its frequency. */
static void put_mode(struct uff_put *put, const struct uff_shape *shape)
{
    double real[6] = {shape->frequency_hz};
    int count = 1;
    if (shape->analysis_type == NORMAL_MODE) {
        real[1] = shape->modal_mass;
        real[2] = shape->damping;
        real[3] = shape->hysteretic;
        count = 4;
    } else if (shape->analysis_type == COMPLEX_FIRST_ORDER || shape->analysis_type == COMPLEX_SECOND_ORDER) {
        memcpy(real, shape->eigenvalue, sizeof shape->eigenvalue);
        memcpy(real + 2, shape->modal_a, sizeof shape->modal_a);
        memcpy(real + 4, shape->modal_b, sizeof shape->modal_b);
        count = 6;
    }
    const int record[] = {2, count, shape->load_case, shape->number};
    uff_put_integers(put, 10, 8, 4, record);
    uff_put_reals(put, 13, 5, 6, count, real);
}

int uff_write_shape(FILE *stream, const struct uff_shape *shape)
{
    int components = shape->component_count, is_complex = shape->is_complex != 0;
    int is_eigenvalue = shape->analysis_type == COMPLEX_FIRST_ORDER || shape->analysis_type == COMPLEX_SECOND_ORDER;
    if (components < 1 || components > 6 || shape->node_count < 0 || (is_complex && shape->node_count && !shape->imag))
        return ROTID_ERROR_ARGUMENT;
    if (is_eigenvalue && shape->frequency_hz > 0 && shape->eigenvalue[0] == 0 && shape->eigenvalue[1] == 0)
        return ROTID_ERROR_ARGUMENT; /* the frequency would be lost */

    struct uff_shape head = *shape;
    head.data_type = is_complex ? 5 : 2;
    struct uff_put put;
    uff_put_open(&put, stream, 55);
    put_ids(&put, shape->id);
    uff_put_record(&put, &uff_kind_55, &head);
    put_mode(&put, shape);
    for (int i = 0; i < shape->node_count && put.status == ROTID_OK; ++i) {
        double value[12];
        for (int c = 0; c < components; ++c) {
            size_t at = (size_t)components * (size_t)i + (size_t)c;
            value[is_complex ? 2 * c : c] = shape->real[at];
            if (is_complex)
                value[2 * c + 1] = shape->imag[at];
        }
        uff_put_integer(&put, 10, shape->node[i]);
        uff_put_line(&put);
        uff_put_reals(&put, 13, 5, 6, components * (is_complex ? 2 : 1), value);
    }
    return uff_put_close(&put);
}
