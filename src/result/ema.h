/* What `rotid ema` finds, in the shape of its JSON. NaN: it cannot be stated. */
#ifndef ROTID_RESULT_EMA_H
#define ROTID_RESULT_EMA_H

/* The doubts of a mode and of a channel as words, in the order of the bits of enum ema_quality_flag and enum
 * ema_channel_quality_flag, and the methods in that of enum ema_method; NULL behind the last. */
extern const char *const ema_mode_doubts[], *const ema_channel_doubts[], *const ema_method_words[];

/* what was measured */
struct ema_source {
    const char *file;          /* path of the file as given */
    int quantity;              /* of the response */
    int transfer_functions;    /* response and reference pairs */
    int lines;                 /* of every transfer function, within --band */
    double low_hz;             /* first line [Hz] */
    double high_hz;            /* last line [Hz] */
    int from_time_records;     /* false: the file holds transfer functions */
    int impacts;               /* found in the time records */
    int impacts_used;          /* those that are not double, cut off or clipped */
    double window_decay_per_s; /* of the exponential window, taken off every pole [1/s]; 0: none */
};

struct ema_point_frequency {
    double frequency_hz;     /* of the mode in the transfer functions of this point alone [Hz]; NaN near a node */
    double frequency_std_hz; /* its standard deviation [Hz] */
};

/* a point; the last two keys with --per-point */
struct ema_shape_point {
    int node;                          /* label of the file */
    int direction;                     /* 0 scalar, 1 to 6 X Y Z RX RY RZ */
    double value;                      /* real shape, largest component 1; NaN where not measured */
    double std;                        /* its standard deviation, the scale of the mode left out */
    double complex_re;                 /* complex shape at the same scale, real part */
    double complex_im;                 /* and imaginary part */
    struct ema_point_frequency *alone; /* NULL: the keys are left out */
};

/* a mode */
struct ema_mode_result {
    int mode;                    /* number in this result and in the file that is written */
    double frequency_hz;         /* undamped, |lambda|/(2 pi) [Hz] */
    double frequency_std_hz;     /* standard deviation [Hz] */
    double damping;              /* fraction of critical damping [1]; NaN where a half-power point lies outside the band
                                    (quadrature) */
    double damping_std;          /* standard deviation [1] */
    double mpc;                  /* modal phase collinearity: 1 for points that move in phase */
    double mpd_degrees;          /* mean phase deviation of the points [degrees] */
    double modal_mass_kg;        /* of the shape whose largest component is 1 [kg]; NaN where no point was struck and measured */
    double peak_signal_to_noise; /* value over its standard deviation at the peak, median of the transfer functions */
    double nearest_hz;           /* nearest other mode [Hz]; NaN where there is one mode */
    int doubts;                  /* what is doubtful about the mode */
    int nshape;
    struct ema_shape_point *shape; /* at every point */
};

/* a pole */
struct ema_pole_result {
    int order;            /* of the denominator */
    double frequency_hz;  /* [Hz] */
    double damping;       /* fraction of critical damping [1] */
    int stable_frequency; /* the order before has it within 0.2 % */
    int stable_damping;   /* and its damping within 5 % */
    int part;             /* 0: of the whole band; parts of a band with very many lines have a table each, counted from 1 */
    int mode;             /* that it was taken for */
};

/* a transfer function */
struct ema_channel_result {
    int response_node;       /* label */
    int response_direction;  /* 0 scalar, 1 to 6 X Y Z RX RY RZ, negative the other way */
    int reference_node;      /* label of the node that was struck */
    int reference_direction; /* as response_direction */
    int averages;            /* impacts in it; 0: not known */
    double frac;             /* FRAC of measured and synthesised values over the band; NaN where it was left out */
    double noise;            /* standard deviation of its lines over their values, both rms */
    int doubts;              /* what is doubtful about it */
};

/* a transfer function with its values */
struct ema_curve {
    int channel; /* number in channels, from 1 */
    int nfrequency_hz;
    double *frequency_hz;   /* lines [Hz] */
    double *measured_re;    /* measured value, real part [of the quantity per newton, SI] */
    double *measured_im;    /* and imaginary part */
    double *synthesised_re; /* value of the modes with what lies beyond the band, real part */
    double *synthesised_im; /* and imaginary part */
};

struct ema_result {
    struct ema_source source; /* what was measured */
    int method;               /* as given by --method */
    int order;                /* highest order of the denominator; 0 for quadrature */
    int refined;              /* false: the poles are those of the method, not refined together */
    int std_from;             /* standard deviations rest on the variance of the lines, from the impacts or from coherences; or on
                                 what the modes leave over */
    const char *output;       /* universal file that the modes were written to */
    int nmodes;
    struct ema_mode_result *modes; /* by rising frequency; empty: none was found */
    const double *mac;             /* modal assurance criterion of the complex shapes with each other, row by row */
    int nstabilisation;
    struct ema_pole_result *stabilisation; /* poles of the tables, order by order, by rising frequency; empty for quadrature */
    int nchannels;
    struct ema_channel_result *channels; /* the transfer functions */
    int nrms_frequency_hz;
    const double *rms_frequency_hz; /* lines of the two below [Hz] */
    const double *rms_measured;     /* root mean square over the transfer functions of the magnitude of the measured values [SI] */
    const double *rms_synthesised;  /* the same of the synthesised values [SI] */
    int ncurves;
    struct ema_curve *curves; /* by rising FRAC: all transfer functions, or of many lines some from the worst to the best */
    double seconds;           /* time taken [s] */
};

#endif
