#include "generated.h"

#include <stdlib.h>
#include <string.h>

#include "deck/deck_row.h"

#define SHELL(PATH, WRITE)                                                                                                       \
    {                                                                                                                            \
        PATH, "# what follows is written by make tables\n", "# end of what make tables writes\n", WRITE, 0                       \
    }
#define CARDS(NAME, SECTION)                                                                                                     \
    {                                                                                                                            \
        "docs/deck.md", "<!-- " NAME ", written by make tables -->\n", "<!-- end -->\n", write_cards, SECTION                    \
    }

const struct generated generated_parts[] = {
    SHELL("completions/rotid.bash", write_bash),
    SHELL("completions/_rotid", write_zsh),
    SHELL("completions/rotid.fish", write_fish),
    {"docs/rotid.1", ".\\\" what follows is written by make tables\n", ".\\\" end of what make tables writes\n", write_manual, 0},
    CARDS("cards of the model", CARD_MODEL),
    CARDS("cards of the measured data", CARD_MEASURED),
    CARDS("card of the causes", CARD_CAUSE),
    CARDS("cards of the identification", CARD_IDENTIFICATION),
    CARDS("card of the transfer functions", CARD_FRF),
    CARDS("cards of the states", CARD_STATES),
    CARDS("cards of the machine in operation", CARD_RUNNING),
    {"docs/reference.md", "<!-- commands, written by make tables -->\n", "<!-- end -->\n", write_commands, 0},
    {"docs/reference.md", "<!-- cards, written by make tables -->\n", "<!-- end -->\n", write_card_list, 0},
    {"docs/reference.md", "<!-- causes, written by make tables -->\n", "<!-- end -->\n", write_causes, 0},
    {NULL, NULL, NULL, NULL, 0}};

char *generated_text(const struct generated *part, const char *text)
{
    const char *begin = strstr(text, part->begin), *end = begin ? strstr(begin, part->end) : NULL;
    char *whole = NULL;
    size_t size;
    FILE *out = end ? open_memstream(&whole, &size) : NULL;
    if (!out)
        return NULL;
    (void)fwrite(text, 1, (size_t)(begin - text) + strlen(part->begin), out);
    part->write(out, part->section);
    (void)fputs(end, out);
    if (fclose(out)) {
        free(whole);
        return NULL;
    }
    return whole;
}
