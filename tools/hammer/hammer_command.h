/* The command line of hammer. */
#ifndef HAMMER_COMMAND_H
#define HAMMER_COMMAND_H

#include "hammer.h"

struct hammer_command {
    struct hammer_options options;
    const char *rotor, *out, *truth, *deck, *modes_file, *state;
    uint64_t seed;
    int ascii, help, truths, damping_given;
};

extern const char hammer_usage[];

/* true_value[argc] takes the --true. HAMMER_OK, or HAMMER_INPUT after a message on standard error. */
int hammer_command_read(int argc, char **argv, const char **true_value, struct hammer_command *command);

#endif
