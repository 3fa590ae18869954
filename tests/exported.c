#include "exported.h"
#include "one_state.h"

#include <unistd.h>

#include "deck/deck.h"

void open_job(const char *text, struct job *job)
{
    char name[] = "/tmp/exported_XXXXXX";
    struct message_list messages;
    int descriptor = mkstemp(name);
    FILE *stream = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
    message_open(&messages, &test_pool);
    int status = deck_read(&test_pool, name, 0, NULL, &messages, job);
    (void)unlink(name);
    for (size_t i = 0; i < messages.count && status; i++)
        print_error("%d: %s\n", messages.item[i].line, messages.item[i].text);
    assert_status(status, ROTID_OK);
}

struct export_model model_of(const char *text)
{
    static struct job job;
    struct export_model model;
    open_job(text, &job);
    assert_status(export_model_open(&test_pool, &job, NULL, "1.2.3", 1, &model), ROTID_OK);
    return model;
}

double quadratic(const struct dense_file *a, const double *u, const double *w)
{
    double sum = 0;
    for (int j = 0; j < a->n; j++)
        for (int i = 0; i < a->n; i++)
            sum += u[i] * a->a[i + (ptrdiff_t)j * a->n] * w[j];
    return sum;
}
