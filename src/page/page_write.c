#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "page/folder.h"
#include "page/folder_files.h"
#include "page/gnuplot.h"
#include "page/page.h"

static int write_scripts(struct document *document, const struct folder *folder, struct figure *const figure[],
                         struct message_list *messages)
{
    int status = ROTID_OK;
    for (int i = 0; i < document->nfigure && !status; i++) {
        const char *name = pool_format(document->pool, "%s.gp", figure[i]->id);
        status = name && figure[i]->script ? folder_write(folder, folder->figures, name, figure[i]->script, messages)
                                           : ROTID_ERROR_MEMORY;
    }
    return status;
}

/* Draws what can be drawn. The hint for the page where that is not all, NULL where it is. */
static int draw(struct document *document, const struct folder *folder, struct figure *const figure[],
                const rotid_environment *environment, struct message_list *messages, struct page_written *written,
                const char **hint)
{
    struct pool *pool = document->pool;
    struct gnuplot gnuplot;
    const char **why = POOL_ARRAY(pool, const char *, document->nfigure);
    int status = why ? gnuplot_find(pool, environment, &gnuplot) : ROTID_ERROR_MEMORY, count = document->nfigure;
    *hint = NULL;
    if (status || !count)
        return status;
    written->gnuplot = gnuplot.version;
    if (!gnuplot.version) {
        message_add(messages, SEVERITY_WARNING, NULL, 0, 0, "no figures: %s; apt-get install gnuplot-nox, then the same command",
                    gnuplot.why);
        *hint = "The figures are missing: gnuplot draws them, and there was none. Their numbers stand in tables instead. "
                "apt-get install gnuplot-nox (or the like), then the same command again, makes the figures; the scripts are in "
                "the folder figures already.";
        return ROTID_OK;
    }
    status = gnuplot_draw(pool, &gnuplot, environment, folder->figures, count, figure, why);
    for (int i = 0; i < count && !status; i++) {
        const char *narrow = pool_format(pool, "%s-narrow.svg", figure[i]->id);
        written->ndrawn += figure[i]->picture[WIDE] != NULL;
        if (narrow)
            (void)unlinkat(folder->figures, narrow, 0); /* it stands in the page */
        if (!why[i])
            continue;
        message_add(messages, SEVERITY_WARNING, NULL, 0, 0, "figure %s is not drawn: %s", figure[i]->id, why[i]);
        *hint = "Some figures are missing: gnuplot failed on them. Their numbers stand in tables instead; the scripts are in the "
                "folder figures.";
    }
    return status;
}

static int write_page(struct document *document, const struct folder *folder, const char *made_by, const char *hint,
                      struct message_list *messages)
{
    char *text = NULL;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    int status = ROTID_ERROR_MEMORY;
    if (!out)
        return status;
    document_write(out, document, made_by, hint);
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed)
        status = folder_write(folder, folder->work, "index.html", text, messages);
    free(text);
    return status;
}

int page_write(struct document *document, const char *path, const char *made_by, const rotid_environment *environment,
               struct message_list *messages, struct page_written *written)
{
    struct folder folder;
    const char *hint;
    struct figure **figure = document_figures(document);
    *written = (struct page_written){.nfigure = document->nfigure};
    if (!figure || document->failed)
        return ROTID_ERROR_MEMORY;
    int status = folder_open(document->pool, path, document->nfigure, figure, messages, &folder);
    if (status)
        return status;
    status = write_scripts(document, &folder, figure, messages);
    if (!status)
        status = draw(document, &folder, figure, environment, messages, written, &hint);
    if (!status)
        status = files_list(&folder, messages);
    if (!status)
        status = write_page(document, &folder, made_by, hint, messages);
    if (!status && environment && environment->cancelled && environment->cancelled(environment->context))
        status = ROTID_STOP_CANCELLED;
    if (status)
        folder_abandon(&folder);
    else
        status = folder_close(&folder, messages);
    return status;
}
