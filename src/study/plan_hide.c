/* HIDE: an effect in the data that the fitted model does not have. It is stated as on a CAUSE card and read as one, at either end
 * of the ranges of its values, when the deck is known. */
#include <string.h>

#include "deck/deck.h"
#include "study/study.h"

/* What the table calls it: its type and what it acts on. */
static const char *label_of(struct plan_reader *reader, const struct card *card)
{
    static const char *const parts[] = {"TYPE", "GROUP", "BETWEEN", "AT", "SENSOR", "SHAPE", "MOUNT"};
    const char *label = "";
    for (size_t p = 0; p < sizeof parts / sizeof *parts && label; p++) {
        const struct card_option *option = card_option(card, parts[p]);
        if (option)
            label = pool_format(reader->fields.pool, "%s%s%s", label, *label ? " " : "", option->value);
        for (int i = 0; i < card->noption && option && label; i++)
            if (!strcmp(parts[p], "BETWEEN") && deck_cause_list_item(card, &card->option[i]))
                label = pool_format(reader->fields.pool, "%s,%s", label, card->option[i].name);
    }
    reader->fields.out_of_memory |= !label;
    return label;
}

/* The card as *CAUSE, whose values are those of field 1 (end 0) or, where there is one, of field 2 (end 1). */
static const struct card *cause_card(struct plan_reader *reader, const struct card *card, int end)
{
    struct pool *pool = reader->fields.pool;
    struct card *cause = POOL_NEW(pool, struct card);
    int named = card_option(card, "NAME") != NULL;
    if (!cause)
        return NULL;
    *cause = (struct card){.name = "CAUSE", .place = card->place, .noption = card->noption + !named, .nline = card->nline};
    cause->option = POOL_ARRAY(pool, struct card_option, cause->noption);
    cause->line = POOL_ARRAY(pool, struct data_line, card->nline);
    if (!cause->option || !cause->line)
        return NULL;
    /* in front: behind BETWEEN=left, the name of the second group may stand last */
    if (!named)
        cause->option[0] =
            (struct card_option){.name = "NAME", .value = "hidden", .place = card->place, .value_place = card->place};
    memcpy(cause->option + !named, card->option, (size_t)card->noption * sizeof *card->option);
    for (int i = 0; i < card->nline; i++) {
        struct data_line *line = &cause->line[i];
        *line = card->line[i];
        line->field = POOL_ARRAY(pool, struct field, line->count);
        if (!line->field)
            return NULL;
        memcpy(line->field, card->line[i].field, (size_t)line->count * sizeof *line->field);
        if (line->count > 2 && end)
            line->field[1] = line->field[2];
        line->count = line->count > 2 ? 2 : line->count;
    }
    return cause;
}

void plan_hide(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    const char *type = deck_option(&reader->fields, card, "TYPE", "id of a cause, or NONE");
    const struct card_option *name = card_option(card, "NAME");
    struct plan_hide hide = {.place = card->place};
    reader->hide_card = card;
    if (!type)
        return;
    int none = same_text(type, "NONE");
    hide.name = name && *name->value ? name->value : none ? "none" : label_of(reader, card);
    for (int i = 0; i < card->nline; i++) {
        if (none)
            deck_error(&reader->fields, card->line[i].place, "TYPE=NONE hides nothing, expected a card without data lines");
        else
            (void)deck_count(&reader->fields, &card->line[i], 3, "parameter, value [, upper value]");
    }
    if (!none) {
        hide.lower = cause_card(reader, card, 0);
        hide.upper = cause_card(reader, card, 1);
        reader->fields.out_of_memory |= !hide.lower || !hide.upper;
    }
    for (int h = 0; h < plan->nhide && hide.name; h++)
        if (same_text(plan->hide[h].name, hide.name))
            deck_error(&reader->fields, card->place, "two *HIDE are called %s, expected another NAME on one of them", hide.name);
    struct plan_hide *added = DECK_APPEND(&reader->fields, plan->hide, plan->nhide, reader->hide_room);
    if (!added || reader->fields.out_of_memory)
        return;
    *added = hide;
    plan->nhide++;
}
