#include "cli/arguments.h"

const struct command_entry command_table[] = {
    {"check", "parse a deck; mass, centre of mass, length, mesh, sensors, warnings", "inp", command_check, READS_DECK},
    {"modes", "frequencies and shapes, full and condensed, beside the measured ones", "inp", command_modes, READS_DECK},
    {"sensitivity", "how the modes depend on parameters (Table 1 and Figure 5 of the paper)", "inp", command_sensitivity,
     READS_DECK},
    {"identify", "fit the parameters of *IDENTIFY to the measured modes, NLopt beside it", "inp", command_identify, READS_DECK},
    {"diagnose", "what the model gets wrong, the cause, the extended model, the gain, the detection limits", "inp",
     command_diagnose, READS_DECK | PARALLEL},
    {"suggest", "what to measure next: sensors, modes and intervals before a test, tests that end an ambiguous diagnosis", "inp",
     command_suggest, READS_DECK | PARALLEL},
    {"frf", "synthesised transfer functions with measured damping, beside measured ones", "inp", command_frf, READS_DECK},
    {"ema", "time records or transfer functions (58, 58b) to modes for *MEASURED", "unv|uff|uf", command_ema, PARALLEL},
    {"export", "the identified model for other programs: Matrix Market, Nastran DMIG, a ROSS script", "inp", command_export,
     READS_DECK},
    {"uff", "what a universal file holds, and what is doubtful in it; with -o: ASCII to binary and back", "unv|uff|uf",
     command_uff, 0},
    {"report", "results that were written with --json as a page with figures", "json|jsonl", command_report, SEVERAL_FILES},
    {"study", "many runs from one plan, or of many decks, resumable", "inp|jsonl", command_study, PARALLEL | SEVERAL_FILES},
    {NULL, NULL, NULL, NULL, 0},
};
