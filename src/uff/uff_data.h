/* What the sets of a universal file hold, as plain structs: one struct a kind of set, the same for reading and writing. Texts are
 * without trailing blanks; NULL stands for a text that the file leaves empty or writes as NONE. Numbers are as in the file: no
 * units applied. */
#ifndef ROTID_UFF_UFF_DATA_H
#define ROTID_UFF_UFF_DATA_H

#define UFF_ID_LINES 5
#define UFF_TEXT     80 /* characters of an ID line */

struct uff_header { /* set 151 */
    char model[UFF_TEXT + 1], description[UFF_TEXT + 1], program[UFF_TEXT + 1];
    char created[UFF_TEXT + 1], saved[UFF_TEXT + 1], written_by[UFF_TEXT + 1], written[UFF_TEXT + 1]; /* date and time as text */
    int version[2], file_type;
};

struct uff_units { /* set 164: a value in SI times the factor is the value in the file */
    int code;      /* 1 SI, 2 foot (lbf), ..., 9 user */
    char description[21];
    int temperature_mode;
    double length, force, temperature, temperature_offset;
};

struct uff_node { /* sets 15, 781, 2411 */
    int id;
    int definition_system, displacement_system, color; /* 0 where there is none */
    double x[3];
};

struct uff_shape { /* one set 55 */
    int line;      /* of the '-1' that opens the set, from 1 */
    char id[UFF_ID_LINES][UFF_TEXT + 1];
    int model_type, analysis_type; /* analysis 0 unknown, 2 normal mode; 3, 7 complex eigenvalue; 5 frequency response */
    int data_characteristic, specific_type,
        data_type; /* 2 vector3, 3 vector6; 8 displacement, 11 velocity, 12 acceleration; 2 real, 5 complex */
    int load_case;
    int number;          /* of the mode, or with analysis type 5 of the frequency; from record 7 */
    double frequency_hz; /* 0: a mode that does not oscillate */
    double damping;      /* viscous ratio, of a complex eigenvalue -Re lambda/|lambda|; 0 where the file has none */
    double hysteretic;   /* hysteretic damping ratio of analysis 2, else 0 */
    double modal_mass;   /* of analysis 2; 0 where there is none */
    double eigenvalue[2], modal_a[2], modal_b[2]; /* of analysis 3 and 7 */
    int is_complex;                               /* imag given */
    int component_count;                          /* values per node, 1 to 6 */
    int node_count;                               /* the format lets a writer leave out nodes whose values are all zero */
    int *node;                                    /* [node_count] ids, distinct, in the order of the file */
    double *real;                                 /* [component_count * node_count], components of a node contiguous */
    double *imag;                                 /* same, or NULL */
};

enum { /* function types of set 58 */
       UFF_GENERAL,
       UFF_TIME,
       UFF_AUTO_SPECTRUM,
       UFF_CROSS_SPECTRUM,
       UFF_TRANSFER,
       UFF_TRANSMISSIBILITY,
       UFF_COHERENCE,
       UFF_AUTO_CORRELATION,
       UFF_CROSS_CORRELATION,
       UFF_AUTO_PSD,
       UFF_ESD,
       UFF_PROBABILITY,
       UFF_SPECTRUM
};

enum { UFF_REAL_SINGLE = 2, UFF_REAL_DOUBLE = 4, UFF_COMPLEX_SINGLE = 5, UFF_COMPLEX_DOUBLE = 6 }; /* ordinate data type */

struct uff_axis {      /* records 8 to 11 of set 58 */
    int specific_type; /* 0 unknown, 1 general, 8 displacement, 9 reaction force, 11 velocity, 12 acceleration, 13 excitation
                          force, 15 pressure, 16 mass, 17 time, 18 frequency, 19 rpm */
    int length, force, temperature; /* exponents of the units */
    char label[21], unit[21];       /* "" for NONE */
};

struct uff_binary { /* first line of set 58b */
    int is_binary;
    int order;  /* 1 little endian, 2 big endian */
    int format; /* 1 DEC VMS, 2 IEEE 754, 3 IBM 5/370 */
    long long text_lines, bytes;
};

struct uff_function { /* sets 58 and 58b without their values */
    int line;         /* of the '-1' that opens the set */
    struct uff_binary binary;
    char id[UFF_ID_LINES][UFF_TEXT + 1];
    int type, number, version, load_case;
    char response_name[11], reference_name[11]; /* "" for NONE */
    int response_node, response_direction;      /* 0 scalar; +-1 x, +-2 y, +-3 z, +-4 to 6 rotations */
    int reference_node, reference_direction;
    int ordinate; /* UFF_REAL_SINGLE ... */
    long long count;
    int is_even;
    double start, step; /* of an even abscissa */
    double z;
    struct uff_axis abscissa, numerator, denominator, z_axis;
};

#endif
