/* What `rotid frf` finds, in the shape of its JSON. */
#ifndef ROTID_RESULT_TRANSFER_H
#define ROTID_RESULT_TRANSFER_H

/* Quantities of the response and units of the functions in the order of enum frf_quantity, sources of a damping in that of enum
 * frf_damping; NULL behind the last. */
extern const char *const transfer_quantity_words[], *const transfer_unit_words[], *const transfer_damping_words[];

/* an identified parameter at whose value the model is taken */
struct transfer_parameter {
    const char *name; /* such as core.E */
    const char *unit; /* of the value; 1 for a pure number */
    double value;     /* [unit] */
};

struct transfer_mode_agreement {
    double frac;                         /* FRAC of all functions over the lines nearest to this mode [1] */
    double frac_at_measured_frequencies; /* the same with measured frequencies in place of the model's [1] */
    double level_db;                     /* measured over synthesised, each at its own resonance, over all functions [dB] */
    double phase_deg;                    /* measured less synthesised there [degrees] */
    int worst_function;                  /* index in functions of the largest deviation */
};

/* a mode; the keys from frac on stand for elastic ones within the lines where there are measured functions */
struct transfer_mode {
    int rigid;                /* a mode on the supports, or of free motion */
    int mode;                 /* number of an elastic mode, from 1 */
    double model_hz;          /* of the full model [Hz] */
    double measured_hz;       /* of the measured mode paired with it, within the lines [Hz] */
    double damping;           /* fraction of critical damping [1] */
    const char *damping_from; /* the measured mode; DAMPING of *FRF; for modes on the supports the smallest, for others the mean
                                 measured ratio */
    struct transfer_mode_agreement *agreement; /* NULL: the keys are left out */
};

struct transfer_agreement {
    double frac;                         /* frequency response assurance criterion [1]; NaN where a function vanishes */
    double frac_at_measured_frequencies; /* the same with the measured frequencies in place of the model's [1] */
    double frac_of_conjugate; /* the same with the conjugate: higher where the measurement has the other sign of time [1] */
    double scale;             /* a of the least sum |measured - a synthesised|^2, below 0: opposite sign [1] */
    double level_db;          /* measured over synthesised [dB] */
};

/* this function at a mode */
struct transfer_at_mode {
    int mode;         /* number, from 1 */
    double level_db;  /* measured over synthesised, each at its own resonance [dB] */
    double phase_deg; /* measured less synthesised there, -180 to 180 [degrees] */
    double deviation; /* largest distance of the curves over the largest measured magnitude, nearest lines [1] */
};

struct transfer_beside {
    struct transfer_agreement agreement;
    int measured_reversed;   /* measured along opposite directions, which is taken into account */
    int measured_reciprocal; /* measured with force and response exchanged */
    int nat_modes;
    struct transfer_at_mode *at_modes; /* elastic modes within the lines */
};

/* a transfer function; frac to at_modes and the measured curve stand where there are measured functions */
struct transfer_function {
    int response;                   /* id of the sensor or node */
    int reference;                  /* id, where the force acts */
    double response_z_m;            /* position in the model [m] */
    double reference_z_m;           /* position in the model [m] */
    struct transfer_beside *beside; /* NULL: the keys are left out */
    int nfrequency_hz;
    double *frequency_hz;   /* lines [Hz]; NULL without curves, whose keys are left out */
    double *synthesised_re; /* real part [unit] */
    double *synthesised_im; /* imaginary part [unit] */
    double *measured_re;    /* real part, in the direction of the model [unit]; NULL: nothing measured */
    double *measured_im;    /* imaginary part [unit] */
};

struct transfer_result {
    int complete;          /* false: interrupted, functions holds those that were finished */
    const char *quantity;  /* of the response */
    const char *unit;      /* of every function */
    int lines;             /* of every function */
    double low_hz;         /* first line [Hz] */
    double high_hz;        /* last line [Hz] */
    double modes_up_to_hz; /* modes are summed up to here [Hz]; the others by value and slope of their sum at the first elastic
                              mode */
    double window_decay;   /* of an exponential window of the measurement, which the synthesis takes over [1/s]; 0: none */
    const char *measured_file; /* universal file of the measured functions */
    int nparameters;
    struct transfer_parameter *parameters; /* at whose values the model is taken; empty: the model as the deck states it */
    int nmodes;
    struct transfer_mode *modes;          /* modes that are summed, by rising frequency */
    struct transfer_agreement *agreement; /* over all functions together */
    int left_out;    /* measured functions that are not lateral along one axis, where all of the file were asked for */
    int with_curves; /* false: too many values, the functions have no curves here; --output has them */
    int nfunctions;
    struct transfer_function *functions; /* transfer functions */
};

#endif
