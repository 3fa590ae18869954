#include "report/report.h"

#include <string.h>

#include "base/base.h"

void html_text(FILE *out, const char *text)
{
    while (*text) {
        size_t bytes = text_utf8(text);
        char c = *text;
        if (!text_visible(text) && c != '\n' && c != '\t')
            (void)fputs(TEXT_REPLACEMENT, out);
        else if (c == '&')
            (void)fputs("&amp;", out);
        else if (c == '<')
            (void)fputs("&lt;", out);
        else if (c == '>')
            (void)fputs("&gt;", out);
        else if (c == '"')
            (void)fputs("&quot;", out);
        else if (c == '\'')
            (void)fputs("&#39;", out);
        else
            (void)fwrite(text, 1, bytes, out);
        text += bytes ? bytes : 1;
    }
}

void html_element(FILE *out, const char *name, const char *text)
{
    (void)fprintf(out, "<%s>", name);
    html_text(out, text);
    (void)fprintf(out, "</%.*s>\n", (int)strcspn(name, " "), name);
}
