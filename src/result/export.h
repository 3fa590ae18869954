/* What `rotid export` has written, in the shape of its JSON. */
#ifndef ROTID_RESULT_EXPORT_H
#define ROTID_RESULT_EXPORT_H

/* Of --format, in the order of enum export_format; NULL behind the last. */
extern const char *const export_format_words[];

/* a parameter of *IDENTIFY; value and std in its unit */
struct export_parameter_result {
    const char *name; /* such as core.E */
    const char *unit; /* 1 for a pure number */
    double value;     /* in the exported model */
    double std;       /* standard deviation; NaN where it cannot be stated or nothing was fitted */
};

struct export_result {
    const char *format; /* as given by --format */
    int nfiles;
    const char **files; /* paths of the files that were written, beginning with the path as given */
    const char *model;  /* stated: as the deck states it, nothing was fitted */
    const char *status; /* of the fit, as rotid identify has it; NULL where nothing was fitted */
    int nparameters;
    struct export_parameter_result *parameters; /* in the order of *IDENTIFY */
    double mass_kg;                             /* of the exported model [kg] */
    double center_of_mass_m;                    /* from the left end [m] */
    int nodes;                                  /* of the model, those of rods and bars included */
    int degrees_of_freedom;                     /* two a node */
    const char *reduction;                      /* of the condensed matrices; NULL where there are none */
    int masters;                                /* rows of the condensed matrices; ROTID_NONE where there are none */
    int nrigid_hz;
    const double *rigid_hz; /* modes of the rotor on its supports, or of free motion, below the first bending mode [Hz] */
    int nfull_hz;
    const double *full_hz; /* bending modes of the deck's model by rising frequency [Hz] */
    int nexported_hz;
    const double *exported_hz; /* bending modes of the model in the file [Hz]: the full one, with dmig --condensed the condensed
                                  one (NaN beyond those it has) */
};

#endif
