/* The page under construction, and the page as a file. */
#include <errno.h>
#include <sys/stat.h>

#include "page/page.h"

/* The results as the script draws them: JSON in which no text can end its element, since < is \u003c, and from which no text
 * shows what the user's file does not say: controls are U+FFFD. Long lists are rounded to what is drawn, runs of studies thinned.
 */

#define LIST_LONG 24   /* numbers: a longer list is drawn, and has six digits */
#define RUNS_MOST 3000 /* of a study */

static void write_text(FILE *out, const char *text)
{
    (void)fputc('"', out);
    while (*text) {
        size_t bytes = text_utf8(text);
        unsigned char c = (unsigned char)*text;
        if (c == '\n' || c == '\t')
            (void)fputs(c == '\n' ? "\\n" : "\\t", out);
        else if (!text_visible(text))
            (void)fputs("\\ufffd", out);
        else if (c == '<' || c == '>' || c == '&')
            (void)fprintf(out, "\\u%04x", c);
        else if (c == '"' || c == '\\')
            (void)fprintf(out, "\\%c", c);
        else
            (void)fwrite(text, 1, bytes, out);
        text += bytes ? bytes : 1;
    }
    (void)fputc('"', out);
}

static void write_number(FILE *out, double value, int is_drawn)
{
    char text[40];
    if (!isfinite(value)) {
        (void)fputs("null", out);
        return;
    }
    (void)snprintf(text, sizeof text, is_drawn ? "%.6g" : "%.15g", value);
    if (!is_drawn && strtod(text, NULL) != value)
        (void)snprintf(text, sizeof text, "%.17g", value);
    (void)fputs(text, out);
}

/* Keys of results that no figure shows. */
static int is_left_out(const char *key)
{
    static const char *const keys[] = {"steps", "extended_deck", "warnings", "cards", "jacobians"};
    int found = 0;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        found |= !strcmp(key, keys[i]);
    return found;
}

static void write_value(FILE *out, const cJSON *json, int is_drawn)
{
    const cJSON *item;
    int first = 1;
    if (!json || cJSON_IsNull(json)) {
        (void)fputs("null", out);
    } else if (cJSON_IsString(json)) {
        write_text(out, json->valuestring);
    } else if (cJSON_IsNumber(json)) {
        write_number(out, json->valuedouble, is_drawn);
    } else if (cJSON_IsBool(json)) {
        (void)fputs(cJSON_IsTrue(json) ? "true" : "false", out);
    } else if (cJSON_IsArray(json)) {
        int is_long = cJSON_GetArraySize(json) > LIST_LONG;
        (void)fputc('[', out);
        cJSON_ArrayForEach(item, json)
        {
            (void)fputs(first ? "" : ",", out);
            write_value(out, item, is_long && cJSON_IsNumber(item));
            first = 0;
        }
        (void)fputc(']', out);
    } else if (cJSON_IsObject(json)) {
        (void)fputc('{', out);
        cJSON_ArrayForEach(item, json)
        {
            if (is_left_out(item->string))
                continue;
            (void)fputs(first ? "" : ",", out);
            write_text(out, item->string);
            (void)fputc(':', out);
            write_value(out, item, 0);
            first = 0;
        }
        (void)fputc('}', out);
    }
}

/* The keys of a run that figures show. */
static void write_run(FILE *out, const cJSON *run)
{
    static const char *const keys[] = {"run",        "cell",  "replicate", "start", "status",  "objective", "chi2_per_dof",
                                       "parameters", "modes", "history",   "truth", "verdict", "score"};
    int first = 1;
    (void)fputc('{', out);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        const cJSON *value = cJSON_GetObjectItemCaseSensitive(run, keys[i]);
        if (!value)
            continue;
        (void)fprintf(out, "%s\"%s\":", first ? "" : ",", keys[i]);
        write_value(out, value, 0);
        first = 0;
    }
    (void)fputc('}', out);
}

/* A study: the summary, and of a file of results its runs, evenly thinned. */
static void write_study(FILE *out, struct pool *pool, const struct result *result)
{
    char *text = result_json(result);
    cJSON *json = text ? cJSON_Parse(text) : NULL;
    pool->out_of_memory |= !json;
    write_value(out, json, 0);
    cJSON_Delete(json);
    free(text);
    if (!cJSON_IsArray(result->json))
        return;
    int runs = cJSON_GetArraySize(result->json) - 1, every = runs / RUNS_MOST + 1, i = -1;
    const cJSON *run;
    (void)fprintf(out, ",\"thinned\":%d,\"runs\":[", every);
    cJSON_ArrayForEach(run, result->json)
    {
        if (i >= 0 && i % every == 0) {
            (void)fputs(i ? ",\n" : "", out);
            write_run(out, run);
        }
        i++;
    }
    (void)fputc(']', out);
}

/* What the program has words for: labels and fates of candidates in their order, names of causes. */
static void write_words(FILE *out, struct pool *pool, const rotid_diagnosis *d)
{
    (void)fputs(",\"words\":[", out);
    for (int i = 0; i < d->ncandidates; i++) {
        (void)fputs(i ? ",[" : "[", out);
        write_text(out, plain_text(pool, cause_label(pool, d, &d->candidates[i].cause)));
        (void)fputc(',', out);
        write_text(out, candidate_fate(pool, d, &d->candidates[i]));
        (void)fputc(']', out);
    }
    (void)fputc(']', out);
    (void)fputs(",\"causes\":[", out);
    const rotid_verdict *v = &d->verdict;
    for (int i = 0; i < v->ncauses + v->nlikely_causes; i++) {
        (void)fputs(i ? "," : "", out);
        write_text(out, plain_text(pool, extended_label(pool, d, i)));
    }
    (void)fputc(']', out);
}

/* The data block: what the script draws from. */
static void data_write(FILE *out, struct pool *pool, int count, const struct result *result)
{
    (void)fputs("<script type=\"application/json\" id=\"data\">[", out);
    for (int i = 0; i < count; i++) {
        (void)fputs(i ? ",\n{\"file\":" : "{\"file\":", out);
        write_text(out, result[i].file);
        (void)fputs(",\"result\":", out);
        if (result[i].study)
            write_study(out, pool, &result[i]);
        else
            write_value(out, result[i].json, 0);
        if (result[i].diagnose)
            write_words(out, pool, result[i].diagnose);
        (void)fputc('}', out);
    }
    (void)fputs("]</script>\n", out);
}

/* ---- the page */

#define FOLDED 12 /* rows: a longer table is folded by the script */
/* What tells that a page is one of rotid: in its first KB. */
#define MARK      "<meta name=\"generator\" content=\"rotid report"
#define MARK_ROOM 1024

int document_open(struct document *document, struct pool *pool)
{
    *document = (struct document){.pool = pool, .title = "", .subtitle = "", .now = {.text = ""}, .state = -1};
    document->body = open_memstream(&document->text, &document->length);
    return document->body ? ROTID_OK : ROTID_ERROR_MEMORY;
}

void document_close(struct document *document)
{
    if (document->body)
        (void)fclose(document->body);
    document->body = NULL;
    free(document->text);
    document->text = NULL;
}

/* The text as the current section shows it. */
static const char *shown(const struct document *document, const char *text)
{
    return document->verbatim || !text ? text : plain_text(document->pool, text);
}

static void element(const struct document *document, const char *name, const char *text)
{
    html_element(document->body, name, or_nothing(shown(document, text)));
}

void document_tile(struct document *document, const char *name, const char *value, const char *note)
{
    if (name && value && document->now.ntiles < TILES_MOST)
        document->now.tile[document->now.ntiles++] = (struct tile){name, value, note};
}

void document_answer(struct document *document, const char *of)
{
    struct answer *made = POOL_NEW(document->pool, struct answer), **at = &document->answers;
    if (made && document->now.text && *document->now.text) {
        *made = document->now;
        made->of = of;
        while (*at && (*at)->tone >= made->tone)
            at = &(*at)->following;
        made->following = *at;
        *at = made;
    }
    document->now = (struct answer){.text = ""};
}

/* Whether an identifier is this one, or this one with a number. */
static int is_like(const char *id, const char *like)
{
    size_t length = strlen(like);
    return !strncmp(id, like, length) && (!id[length] || (id[length] == '-' && id[length + 1] >= '0' && id[length + 1] <= '9'));
}

void document_section(struct document *document, const char *id, const char *text, const char *figures)
{
    struct heading *heading = POOL_NEW(document->pool, struct heading);
    int taken = 0;
    for (const struct heading *other = document->first; other; other = other->following)
        taken += is_like(other->id, id);
    id = taken ? pool_text(document->pool, "%s-%d", id, taken + 1) : id;
    text = document->of ? pool_text(document->pool, "%s: %s", text, document->of) : text;
    if (!heading)
        return;
    *heading = (struct heading){.id = id, .text = text};
    *(document->last ? &document->last->following : &document->first) = heading;
    document->last = heading;
    (void)fprintf(document->body, "%s<section id=\"%s\">\n", document->in_section ? "</section>\n" : "", id);
    document->in_section = 1;
    element(document, "h2", text);
    if (figures)
        document_figures(document, figures);
}

void document_heading(struct document *document, const char *text)
{
    element(document, "h3", text);
}

void document_paragraph(struct document *document, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    element(document, "p", pool_text_of(document->pool, format, values));
    va_end(values);
}

void document_list(struct document *document, int count, const char *const text[])
{
    (void)fputs(count ? "<ul>\n" : "", document->body);
    for (int i = 0; i < count; i++)
        element(document, "li", text[i]);
    (void)fputs(count ? "</ul>\n" : "", document->body);
}

void document_facts(struct document *document, int count, const char *const name[], const char *const value[])
{
    (void)fputs("<dl>\n", document->body);
    for (int i = 0; i < count; i++)
        if (value[i]) {
            (void)fputs("<div>", document->body);
            html_element(document->body, "dt", name[i]);
            element(document, "dd", value[i]);
            (void)fputs("</div>\n", document->body);
        }
    (void)fputs("</dl>\n", document->body);
}

void document_table(struct document *document, const struct table *table)
{
    if (!table || table->pool->out_of_memory || !table_rows(table))
        return;
    int folded = table_rows(table) > FOLDED;
    if (folded) {
        (void)fprintf(document->body, "<details class=\"fold\" open=\"\"><summary>%d rows: ", table_rows(table));
        html_text(document->body, plain_text(document->pool, table->caption));
        (void)fputs("</summary>\n", document->body);
    }
    table_write_html(document->body, table, ++document->ntables, plain_text);
    (void)fputs(folded ? "</details>\n" : "", document->body);
}

void document_figures(struct document *document, const char *group)
{
    (void)fprintf(document->body, "<div class=\"figures\" data-group=\"%s\" data-result=\"%d\"", group, document->result);
    if (document->state >= 0)
        (void)fprintf(document->body, " data-state=\"%d\"", document->state);
    (void)fputs("></div>\n", document->body);
}

/* Nothing is loaded, and nothing runs but what was embedded when the program was built. */
static void write_head(FILE *out, const struct document *document)
{
    (void)fputs(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" "
        "content=\"default-src 'none'; img-src data: blob:; style-src 'sha256-",
        out);
    (void)fprintf(out, "%s'; ", page_style_hash);
    if (*page_script)
        (void)fprintf(out, "script-src 'sha256-%s'; require-trusted-types-for 'script'; ", page_script_hash);
    (void)fputs("base-uri 'none'; form-action 'none'\">\n" MARK " " ROTID_VERSION "\">\n"
                "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                "<meta name=\"color-scheme\" content=\"light dark\">\n",
                out);
    html_element(out, "title", document->title);
    (void)fprintf(out, "<style>%s</style>\n</head>\n<body>\n", page_style);
}

static void write_answer(FILE *out, const struct document *document, const struct answer *answer)
{
    static const char *const words[] = {"plain", "good", "care", "bad"};
    static const char *const says[] = {NULL, "Can be relied on", "To be used with care", "Not reliable"};
    const char *headline = answer->headline ? answer->headline : says[answer->tone];
    (void)fprintf(out, "<section class=\"answer %s\" aria-label=\"Answer%s", words[answer->tone], answer->of ? ": " : "");
    html_text(out, answer->of ? answer->of : "");
    (void)fputs("\">\n", out);
    if (answer->of)
        html_element(out, "p class=\"of\"", answer->of);
    if (headline)
        html_element(out, "p class=\"tone\"", plain_text(document->pool, headline));
    html_element(out, "p class=\"says\"", plain_text(document->pool, answer->text));
    (void)fputs(answer->ntiles ? "<dl class=\"tiles\">\n" : "", out);
    for (int i = 0; i < answer->ntiles; i++) {
        (void)fputs("<div>", out);
        html_element(out, "dt", answer->tile[i].name);
        html_element(out, "dd class=\"large\"", answer->tile[i].value);
        if (answer->tile[i].note)
            html_element(out, "dd", answer->tile[i].note);
        (void)fputs("</div>\n", out);
    }
    (void)fputs(answer->ntiles ? "</dl>\n" : "", out);
    if (answer->next)
        html_element(out, "p class=\"next\"", plain_text(document->pool, answer->next));
    (void)fputs("</section>\n", out);
}

static void write_page(FILE *out, struct document *document, int count, const struct result *result, const char *made_by)
{
    write_head(out, document);
    (void)fputs("<header>\n", out);
    html_element(out, "h1", document->title);
    html_element(out, "p class=\"subtitle\"", document->subtitle);
    (void)fputs("</header>\n<main>\n", out);
    for (const struct answer *answer = document->answers; answer; answer = answer->following)
        write_answer(out, document, answer);
    if (!*page_script)
        html_element(
            out, "p class=\"hint\"",
            "This rotid was built without D3, so the page has no figures. With D3 (tools/setup), make and the same command "
            "they are there.");
    (void)fputs("<nav aria-label=\"Contents\"><ul>\n", out);
    for (const struct heading *heading = document->first; heading; heading = heading->following) {
        (void)fprintf(out, "<li><a href=\"#%s\">", heading->id);
        html_text(out, plain_text(document->pool, heading->text));
        (void)fputs("</a></li>\n", out);
    }
    (void)fprintf(out, "</ul></nav>\n%s%s</main>\n<footer>\n", document->text, document->in_section ? "</section>\n" : "");
    html_element(out, "p", made_by);
    if (*page_script) {
        (void)fputs("<details class=\"fold\"><summary>Licence of D3, which draws the figures</summary><pre>", out);
        html_text(out, page_licence);
        (void)fputs("</pre></details>\n", out);
    }
    (void)fputs("</footer>\n", out);
    if (*page_script) {
        data_write(out, document->pool, count, result);
        (void)fprintf(out, "<script>%s</script>\n", page_script);
    }
    (void)fputs("</body>\n</html>\n", out);
}

static int say(struct message_list *messages, const char *path, const char *what, int status)
{
    return message_refuse(messages, status, NULL, 0, 0, "cannot write %s: %s", path, what);
}

/* Whether there is a file that rotid did not write, or no file at all but something else. */
static const char *what_is_lost(const char *path)
{
    char text[MARK_ROOM + 1];
    struct stat is;
    if (lstat(path, &is) != 0)
        return NULL;
    if (!S_ISREG(is.st_mode))
        return "it is no regular file, expected a new name or a page of rotid";
    FILE *file = fopen(path, "r");
    size_t length = file ? fread(text, 1, MARK_ROOM, file) : 0;
    if (file)
        (void)fclose(file);
    text[length] = 0;
    return is.st_size && !strstr(text, MARK) ? "the file that is there is no page of rotid, expected a new name" : NULL;
}

/* The file that a page goes into, its folders made; NULL with a message. */
static const char *file_of(struct pool *pool, const char *path, struct message_list *messages, int *status)
{
    struct stat is;
    size_t length = strlen(path);
    int is_folder = stat(path, &is) == 0 && S_ISDIR(is.st_mode), is_file = length > 5 && !strcmp(path + length - 5, ".html");
    *status = ROTID_ERROR_IO;
    if (!length || !strcmp(path, "-")) {
        (void)say(messages, path, "expected the name of a file or of a folder", *status);
        return NULL;
    }
    for (const char *slash = strchr(path + 1, '/'); slash && slash[1]; slash = strchr(slash + 1, '/'))
        (void)mkdir(pool_text(pool, "%.*s", (int)(slash - path), path), 0777); /* what fails is told where the file is opened */
    if (is_file && !is_folder) {
        *status = ROTID_OK;
        return path;
    }
    if (!is_folder && mkdir(path, 0777) != 0) {
        (void)say(messages, path, errno == EEXIST ? "is a file, expected a folder, a new name, or one in .html" : strerror(errno),
                  *status = errno == EEXIST ? ROTID_ERROR_ARGUMENT : ROTID_ERROR_IO);
        return NULL;
    }
    const char *file = pool_format(pool, "%s%sindex.html", path, path[length - 1] == '/' ? "" : "/");
    *status = file ? ROTID_OK : ROTID_ERROR_MEMORY;
    return file;
}

int page_write(struct document *document, int count, const struct result *result, const char *path, const char *made_by,
               struct message_list *messages, const char **file)
{
    struct output output;
    int status;
    if (document->pool->out_of_memory || fflush(document->body) != 0 || ferror(document->body))
        return ROTID_ERROR_MEMORY;
    *file = file_of(document->pool, path, messages, &status);
    if (!*file)
        return status;
    const char *lost = what_is_lost(*file);
    if (lost)
        return say(messages, *file, lost, ROTID_ERROR_ARGUMENT);
    status = output_open(&output, *file);
    if (!status) {
        write_page(output.stream, document, count, result, made_by);
        status = output_close(&output, document->pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK);
    }
    return status == ROTID_ERROR_IO ? say(messages, *file, output_error(), status) : status;
}
