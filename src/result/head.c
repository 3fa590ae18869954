#include "result/result.h"

#include <math.h>
#include <string.h>

#include "record/rows.h"

PART_TABLE(reference_record, rotid_reference) = {
    TEXT(rotid_reference, quantity, 0),
    NUMBERS(rotid_reference, values, ELEMENTS_MAY_BE_NULL),
    {0},
};

TABLE(provenance_record, struct result_head) = {
    INTEGER(struct result_head, schema, FROM_1),
    TEXT(struct result_head, rotid, 0),
    TEXT(struct result_head, commit, 0),
    TEXT(struct result_head, blas, 0),
    NUMBER(struct result_head, seed, FROM_0 | WHOLE),
    INTEGER(struct result_head, threads, FROM_1),
    TEXT(struct result_head, command, 0),
    {0},
};

TABLE(deck_record, struct result_head) = {
    TEXT(struct result_head, deck, 0),
    TEXTS(struct result_head, heading, SINCE_LATER),
    STRUCTS(struct result_head, references, SINCE_LATER, reference_record),
    TEXT(struct result_head, length_unit, IF_KNOWN),
    TEXT(struct result_head, frequency_unit, IF_KNOWN),
    {0},
};

const rotid_reference *head_reference(const struct result_head *head, const char *quantity)
{
    for (int i = 0; i < head->nreferences; i++)
        if (!strcmp(head->references[i].quantity, quantity))
            return &head->references[i];
    return NULL;
}

double reference_value(const rotid_reference *reference, int k)
{
    return reference && k < reference->nvalues ? reference->values[k] : NAN;
}
