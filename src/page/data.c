/* The results as the script draws them: JSON in which no text can end its element, since < is \u003c, and from which no text
 * shows what the user's file does not say: controls are U+FFFD. Long lists are rounded to what is drawn, runs of studies thinned.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "page/page.h"
#include "result/result.h"

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

static void write_key(FILE *out, const char *key)
{
    (void)fprintf(out, ",\"%s\":", key);
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
    struct result summary = *result;
    char *text = result_json(&summary);
    cJSON *json = text ? cJSON_Parse(text) : NULL;
    pool->out_of_memory |= !json;
    write_value(out, json, 0);
    cJSON_Delete(json);
    json_free(text);
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
    write_key(out, "words");
    (void)fputc('[', out);
    for (int i = 0; i < d->ncandidates; i++) {
        (void)fputs(i ? ",[" : "[", out);
        write_text(out, cause_label(pool, d, &d->candidates[i].cause));
        (void)fputc(',', out);
        write_text(out, candidate_fate(pool, d, &d->candidates[i]));
        (void)fputc(']', out);
    }
    (void)fputc(']', out);
    write_key(out, "causes");
    (void)fputc('[', out);
    for (int i = 0; i < d->verdict.ncauses; i++) {
        (void)fputs(i ? "," : "", out);
        write_text(out, plain_text(pool, cause_label(pool, d, &d->verdict.causes[i])));
    }
    (void)fputc(']', out);
}

void data_write(FILE *out, struct pool *pool, int count, const struct result *result)
{
    (void)fputs("<script type=\"application/json\" id=\"data\">[", out);
    for (int i = 0; i < count; i++) {
        (void)fputs(i ? ",\n{\"file\":" : "{\"file\":", out);
        write_text(out, result[i].file);
        write_key(out, "result");
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
