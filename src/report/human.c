#include "report/report.h"

#define DASH         "\xe2\x80\x93"
#define MINUS        "\xe2\x88\x92"
#define NARROW_SPACE "\xc2\xa0" /* that does not break */
#define WIDEST       1e9        /* from here on in a column with a power of ten */
#define SMALL        1e-3       /* below, more zeros than a reader counts */

const char *or_nothing(const char *text)
{
    return text ? text : "";
}

static struct human_unit length = {1, "m"}, frequency = {1, "Hz"}; /* human_units_of */

static void take_unit(const char *word, struct human_unit *unit)
{
    static const struct human_unit units[] = {{1e2, "cm"},   {1e3, "mm"}, {1 / 0.0254, "in"},
                                              {1e-3, "kHz"}, {60, "rpm"}, {TWO_PI, "rad/s"}};
    for (size_t i = 0; word && i < sizeof units / sizeof *units; i++)
        if (!strcmp(units[i].text, word))
            *unit = units[i];
}

void human_units_of(const struct result_head *head)
{
    take_unit(head->length_unit, &length);
    take_unit(head->frequency_unit, &frequency);
}

struct human_unit human_unit(double value, const char *unit)
{
    static const struct {
        const char *unit, *shown;
        int prefixed;
    } units[] = {{"Pa", "Pa", 1},
                 {"N/m", "N/m", 1},
                 {"N.m/rad", "N\xc2\xb7m/rad", 1},
                 {"N", "N", 1},
                 {"1", "", 0},
                 {"kg.m2", "kg\xc2\xb7m\xc2\xb2", 0},
                 {"kg/m3", "kg/m\xc2\xb3", 0}};
    static const struct {
        double from;
        const char *prefix;
    } prefixes[] = {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {0, ""}};
    struct human_unit human = {1, ""};
    unit = unit ? unit : "1";
    if (!strcmp(unit, "m"))
        return length;
    if (!strcmp(unit, "Hz"))
        return frequency;
    (void)snprintf(human.text, sizeof human.text, "%s", unit);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(units[i].unit, unit))
            continue;
        int p = 0;
        while (units[i].prefixed ? fabs(value) < prefixes[p].from : prefixes[p].from > 0)
            p++;
        human.factor = prefixes[p].from > 0 ? 1 / prefixes[p].from : 1;
        (void)snprintf(human.text, sizeof human.text, "%s%s", prefixes[p].prefix, units[i].shown);
    }
    return human;
}

int human_decimals(double value, double spread)
{
    double size = isfinite(spread) && spread > 0 ? log10(spread) - 2 : value != 0 ? log10(fabs(value)) - 3 : 0;
    int decimals = (int)ceil(-floor(size) - 1e-9);
    int most = value != 0 && fabs(value) < SMALL ? 20 : 8; /* a small one is shown with a power of ten */
    return decimals < 0 ? 0 : decimals > most ? most : decimals;
}

/* 1.0e-8 as decks have it: text is what %e makes of the magnitude. */
static const char *with_power(struct pool *pool, double value, const char *plus, char *text)
{
    char *e = strchr(text, 'e');
    int exponent = 0;
    (void)sscanf(e, "e%d", &exponent); /* NOLINT: of two or three digits */
    *e = 0;
    return pool_text(pool, "%s%se%d", value < 0 ? MINUS : plus, text, exponent);
}

static const char *fixed(struct pool *pool, double value, int decimals, const char *plus)
{
    char digits[400];
    if (!isfinite(value))
        return DASH;
    int left = decimals + (value != 0 ? (int)floor(log10(fabs(value))) : 0); /* digits behind the first one that is not 0 */
    if (fabs(value) < SMALL && value != 0 && decimals > 3 && left >= 0) {
        (void)snprintf(digits, sizeof digits, "%.*e", left, fabs(value));
        return with_power(pool, value, plus, digits);
    }
    (void)snprintf(digits, sizeof digits, "%.*f", decimals, fabs(value));
    int zero = strspn(digits, "0.") == strlen(digits); /* -0.00 is no negative number to people */
    return pool_text(pool, "%s%s", zero ? "" : value < 0 ? MINUS : plus, digits);
}

const char *human_column(struct pool *pool, double value, int decimals, const char *plus)
{
    char digits[64];
    if (!isfinite(value))
        return DASH;
    if (fabs(value) >= WIDEST)
        return pool_text(pool, "%s%s", value > 0 ? plus : "", human_digits(pool, value, 2));
    (void)snprintf(digits, sizeof digits, "%.*f", decimals, fabs(value));
    int zero = strspn(digits, "0.") == strlen(digits);
    return pool_text(pool, "%s%s", value < 0 && !zero ? MINUS : zero ? "" : plus, digits);
}

const char *human_fixed(struct pool *pool, double value, int decimals)
{
    return fixed(pool, value, decimals, "");
}

const char *human_signed(struct pool *pool, double value, int decimals)
{
    return fixed(pool, value, decimals, "+");
}

const char *human_digits(struct pool *pool, double value, int digits)
{
    char text[64];
    if (!isfinite(value))
        return DASH;
    if (value == 0)
        return "0";
    (void)snprintf(text, sizeof text, "%.*e", digits - 1, fabs(value));
    int exponent = 0;
    (void)sscanf(strchr(text, 'e'), "e%d", &exponent); /* NOLINT: of two or three digits */
    if (exponent >= -3 && exponent < 6)
        return fixed(pool, value, exponent >= digits ? 0 : digits - 1 - exponent, "");
    return with_power(pool, value, "", text);
}

const char *human_trimmed(struct pool *pool, double value, int digits)
{
    char *number = pool_copy_text(pool, human_digits(pool, value, digits));
    if (number && strchr(number, '.') && !strchr(number, 'e')) {
        char *end = number + strlen(number);
        while (end[-1] == '0')
            *--end = 0;
        if (end[-1] == '.')
            end[-1] = 0;
    }
    return or_nothing(number);
}

const char *human_value(struct pool *pool, double value, const char *unit)
{
    struct human_unit shown = human_unit(value, unit);
    return pool_text(pool, "%s%s%s", human_trimmed(pool, value * shown.factor, 4), *shown.text ? NARROW_SPACE : "", shown.text);
}

const char *human_quote(struct pool *pool, double value, const double ci[2], const char *unit)
{
    struct human_unit shown = human_unit(value, unit);
    double half = (ci[1] - ci[0]) / 2 * shown.factor;
    char text[32];
    int exponent = 0;
    if (!isfinite(half) || half <= 0)
        return NULL;
    (void)snprintf(text, sizeof text, "%.1e", half);
    (void)sscanf(strchr(text, 'e'), "e%d", &exponent); /* NOLINT: of two or three digits */
    int last = *text < '3' ? exponent - 1 : exponent;  /* power of ten of the last digit */
    double whole = pow(10, last);                      /* 123 +- 40 is 120 +- 40, 115.002 +- 0.138 is 115.00 +- 0.14 */
    return pool_text(
        pool, "%s \xc2\xb1 %s%s%s", human_fixed(pool, round(value * shown.factor / whole) * whole, last < 0 ? -last : 0),
        human_fixed(pool, round(half / whole) * whole, last < 0 ? -last : 0), *shown.text ? NARROW_SPACE : "", shown.text);
}

const char *human_range(struct pool *pool, double from, double to, const char *unit)
{
    struct human_unit shown = human_unit(to, unit);
    return pool_text(pool, "%s to %s%s%s", human_trimmed(pool, from * shown.factor, 5), human_trimmed(pool, to * shown.factor, 5),
                     *shown.text ? NARROW_SPACE : "", shown.text);
}

const char *human_interval(struct pool *pool, double value, const double ci[2], const char *unit)
{
    struct human_unit shown = human_unit(value, unit);
    double f = shown.factor, half = (ci[1] - ci[0]) / 2 * f;
    if (!isfinite(half))
        return human_value(pool, value, unit);
    int decimals = human_decimals(value * f, 10 * half); /* two digits of half the interval */
    return pool_text(pool, "%s%s%s (95" NARROW_SPACE "%%: %s to %s)", human_fixed(pool, value * f, decimals),
                     *shown.text ? NARROW_SPACE : "", shown.text, human_fixed(pool, ci[0] * f, decimals),
                     human_fixed(pool, ci[1] * f, decimals));
}

const char *human_count(struct pool *pool, int count)
{
    static const char *const words[] = {"no",    "one",   "two",  "three", "four",   "five",  "six",
                                        "seven", "eight", "nine", "ten",   "eleven", "twelve"};
    return count >= 0 && count <= 12 ? words[count] : pool_text(pool, "%d", count);
}

const char *human_plural(int count, const char *one, const char *many)
{
    return count == 1 ? one : many;
}

const char *human_seconds(struct pool *pool, double seconds)
{
    return seconds < 1     ? pool_text(pool, "%s" NARROW_SPACE "ms", human_digits(pool, 1e3 * seconds, 2))
           : seconds < 120 ? pool_text(pool, "%s" NARROW_SPACE "s", human_digits(pool, seconds, 2))
                           : pool_text(pool, "%.0f" NARROW_SPACE "min", seconds / 60);
}
