/* Options of a deck that are replaced for one run. */
#include <string.h>

#include "deck/deck.h"
#include "rotid.h"

int override_parse(struct pool *pool, const char *text, struct override *override)
{
    const char *dot = strchr(text, '.'), *equals = strchr(text, '=');
    if (!dot || !equals || dot > equals || dot == text || equals == dot + 1 || !equals[1])
        return ROTID_ERROR_SYNTAX;
    *override = (struct override){pool_format(pool, "%.*s", (int)(dot - text), text),
                                  pool_format(pool, "%.*s", (int)(equals - dot - 1), dot + 1), equals + 1,
                                  pool_format(pool, "--set %s", text), text};
    return override->card && override->option && override->text ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int deck_text_override(struct pool *pool, const struct override *override, struct message_list *messages, struct deck_text *text)
{
    static const char *const single[] = {"FIT", "NOISE", "SLING", "MEASURED", "FRF"};
    struct place place = {override->text, 1, 1};
    struct card_option option = {override->option, override->value, place, place, 1};
    int found = 0;
    for (int i = 0; i < text->ncard; i++)
        found |= same_text(text->card[i].name, override->card);
    for (size_t s = 0; s < sizeof single / sizeof *single && !found; s++)
        if (same_text(single[s], override->card)) {
            if (!deck_text_add_card(pool, text, single[s], place))
                return ROTID_ERROR_MEMORY;
            found = 1;
        }
    if (!found) {
        message_add(messages, SEVERITY_ERROR, place.file, 1, 1, "the deck has no card *%s, expected one that it has",
                    override->card);
        return ROTID_ERROR_SYNTAX;
    }
    for (int i = 0; i < text->ncard; i++) {
        struct card *card = &text->card[i];
        if (!same_text(card->name, override->card))
            continue;
        struct card_option *present = (struct card_option *)card_option(card, override->option);
        if (present)
            *present = option;
        else if (deck_text_add_option(pool, card, option))
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}
