#include "read_states.h"

#include "deck/deck.h"
#include "folder.h"
#include "support.h"

struct states read_states(const char *text)
{
    struct message_list messages;
    struct states states;
    message_open(&messages, &test_pool);
    int status = deck_read_states(&test_pool, folder_write("states.inp", text), NULL, 0, NULL, &messages, &states);
    for (size_t i = 0; i < messages.count && status; i++)
        print_error("%d:%d: %s\n%s\n", messages.item[i].line, messages.item[i].column, messages.item[i].text, text);
    assert_status(status, ROTID_OK);
    return states;
}
