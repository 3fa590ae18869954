#include "cli/cli.h"

const struct command_entry command_table[] = {
    {"check", "parse a deck; mass, centre of mass, length, mesh, sensors, warnings",
     "rotid check rotor.inp\n"
     "rotid check rotor.inp --json -",
     "inp", command_check, READS_DECK},
    {"modes", "frequencies and shapes, full and condensed, compared with the measured ones",
     "rotid modes rotor.inp\n"
     "rotid modes rotor.inp --csv rotor\n"
     "rotid modes rotor.inp --set FIT.MODEL=SOLID --compare",
     "inp", command_modes, READS_DECK},
    {"sensitivity", "how the modes depend on parameters (Table 1 and Figure 5 of the paper)",
     "rotid sensitivity rotor.inp\n"
     "rotid sensitivity rotor.inp --at core.E=8e10,core.G --step 0.001",
     "inp", command_sensitivity, READS_DECK},
    {"identify", "fit the parameters of *IDENTIFY to the measured modes, with NLopt as a check",
     "rotid identify rotor.inp\n"
     "rotid identify rotor.inp --set FIT.HOLDOUT=5,6 --json result.json",
     "inp", command_identify, READS_DECK},
    {"diagnose", "causes of a misfit, extended model, gain, detection limits",
     "rotid diagnose rotor.inp\n"
     "rotid diagnose rotor.inp --extended extended.inp --json result.json",
     "inp", command_diagnose, READS_DECK | PARALLEL},
    {"suggest", "the next measurement: sensors, modes and intervals before a test, tests that separate ambiguous explanations",
     "rotid suggest plan.inp --sensors 10 --interval 1\n"
     "rotid suggest rotor.inp --extended next.inp",
     "inp", command_suggest, READS_DECK | PARALLEL},
    {"speeds", "the machine in operation (*RUNNING): critical speeds, stability, unbalance response, margins, with bands",
     "rotid speeds machine.inp\n"
     "rotid speeds machine.inp --speeds 0:12000:61 --campbell campbell.csv",
     "inp", command_speeds, READS_DECK | PARALLEL},
    {"frf", "synthesised transfer functions with measured damping, compared with measured ones",
     "rotid frf rotor.inp\n"
     "rotid frf rotor.inp --set FRF.FILE=measured.unv -o synthesised.unv",
     "inp", command_frf, READS_DECK},
    {"ema", "time records or transfer functions (58, 58b, or a table of an analyser) to modes for *MEASURED",
     "rotid ema records.unv --band 200,3200 -o modes.unv\n"
     "rotid ema records.unv --pick 415,722 --per-point\n"
     "rotid ema first.unv second.unv third.unv -o modes.unv",
     "unv|uff|uf|csv", command_ema, PARALLEL | SEVERAL_FILES},
    {"test", "from records of a hammer test and a deck to a page: ema, identify, diagnose, report, each printed as a command",
     "rotid test records.unv rotor.inp -o page.html\n"
     "rotid test records.unv rotor.inp -o page.html --band 200,3200",
     "unv|uff|uf|csv|inp", command_test, SEVERAL_FILES},
    {"export", "the identified model for other programs: Matrix Market, Nastran DMIG",
     "rotid export rotor.inp --format matrix-market -o rotor\n"
     "rotid export rotor.inp --format dmig --condensed -o rotor.dmig",
     "inp", command_export, READS_DECK},
    {"uff", "contents and doubtful places of a universal file",
     "rotid uff records.unv --verbose\n"
     "rotid uff modes.unv --csv modes",
     "unv|uff|uf", command_uff, 0},
    {"report", "results of --json as a page with figures", "rotid report identify.json diagnose.json -o page.html", "json|jsonl",
     command_report, SEVERAL_FILES},
    {"study", "many runs from one plan, or of many decks, resumable",
     "rotid study plan.inp -o results.jsonl\n"
     "rotid study part1.jsonl part2.jsonl -o results.jsonl --merge",
     "inp|jsonl", command_study, PARALLEL | SEVERAL_FILES},
    {NULL, NULL, NULL, NULL, NULL, 0},
};
