/* What is required, and whether it holds. */
#include <math.h>

#include "power.h"

#define VISIBLE      30.0  /* a drop from which an effect has to be reported */
#define LARGE        150.0 /* and one from which its name has to be found */
#define LISTED_SHARE 0.99
#define CLEAR_MARGIN 15.0 /* lead of the true cause from which its name has to be right */
#define CLEAR_LEFT   60.0 /* outside the catalogue: no cause comes nearer to the data */

enum {
    FALSE_ALARM,
    WRONG_NAME,
    NAMED,
    LISTED,
    PAIR_BOTH,
    PAIR_WRONG,
    OUTSIDE_NO_NAME,
    MIXTURE,
    ACCUSED,
    DIAGNOSED,
    REQUIRED, /* the others are shown beside them */
    REPORTED = REQUIRED,
    FREQUENCIES,
    COVERAGE,
    REFITTED,
    ACCUSED_ANY,
    CLEARLY_NAMED,
    ANY_WRONG,
    PAIR_SHAPES,
    PAIR_ANY_WRONG,
    OUTSIDE_LEFT,
    OUTSIDE_MIXTURE,
    DATA_FOUND,
    DATA_PHYSICAL,
    NOISE_NAME,
    COLOURED_ALARM,
    CAUSE_COVERAGE,
    LINES
};

/* A share counts what is good (the least is what may not be missed) or what is bad (the most may not be exceeded). The other end
 * is missed only beyond the interval of the share: few cases may all be right. */
static const struct {
    const char *text;
    int bad;
    double least, most;
} table[LINES] = {
    [FALSE_ALARM] = {"nothing hidden: false alarms", 1, 0.01, 0.05},
    [WRONG_NAME] = {"one effect or fault worth 30: wrong name", 1, 0, 0.005},
    [NAMED] = {"one effect worth 150, shapes: named alone", 0, 0.95, 1},
    [LISTED] = {"one effect worth 30: among what shares 99 %", 0, 0.98, 1},
    [PAIR_BOTH] = {"two effects worth 150 each: both named", 0, 0.70, 1},
    [PAIR_WRONG] = {"two effects worth 150 each: wrong name", 1, 0, 0.01},
    [OUTSIDE_NO_NAME] = {"outside the catalogue: no name", 0, 0.90, 1},
    [MIXTURE] = {"95 % intervals of E and G hold the truth", 0, 0.93, 0.97},
    [ACCUSED] = {"sound sensors: accused", 1, 0, 0.005},
    [DIAGNOSED] = {"a diagnosis, and no error", 0, 1, 1},
    [REPORTED] = {"one effect worth 30: reported", 0, 0, 1},
    [FREQUENCIES] = {"one effect worth 150, frequencies alone: the same", 0, 0, 1},
    [COVERAGE] = {"the same of a model that was named right", 0, 0, 1},
    [REFITTED] = {"one effect worth 30: the true cause refitted", 0, 0, 1},
    [ACCUSED_ANY] = {"sound sensors, numbers or noise: accused", 1, 0, 1},
    [CLEARLY_NAMED] = {"one effect, margin 15: named, or one of two", 0, 0, 1},
    [ANY_WRONG] = {"one effect of any size: wrong name", 1, 0, 1},
    [PAIR_SHAPES] = {"two effects worth 150 each, shapes: both named", 0, 0, 1},
    [PAIR_ANY_WRONG] = {"two effects of any size: wrong name", 1, 0, 1},
    [OUTSIDE_LEFT] = {"outside, 60 left by the best causes: no name", 0, 0, 1},
    [OUTSIDE_MIXTURE] = {"outside: 95 % intervals of E and G", 0, 0, 1},
    [DATA_FOUND] = {"fault of the data worth 60: found", 0, 0, 1},
    [DATA_PHYSICAL] = {"fault of the data: physical name", 1, 0, 1},
    [NOISE_NAME] = {"noise stated wrongly: physical name", 1, 0, 1},
    [COLOURED_ALARM] = {"correlated noise, nothing hidden: reported", 1, 0, 1},
    [CAUSE_COVERAGE] = {"95 % intervals of named causes: hold the truth", 0, 0, 1},
};

void power_interval(struct power_share share, double *lower, double *upper)
{
    const double z = 1.959963984540054;
    double n = share.count, p = n > 0 ? share.right / n : 0;
    double centre = n > 0 ? (p + z * z / (2 * n)) / (1 + z * z / n) : 0.5;
    double half = n > 0 ? z * sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n) : 0.5;
    *lower = fmax(0, centre - half);
    *upper = fmin(1, centre + half);
}

static void add(struct power_share *share, int counts)
{
    share->count++;
    share->right += counts;
}

static void add_physical(const struct hidden_score *s, struct power_share share[LINES])
{
    int wrong = s->outcome == HIDDEN_WRONG, named = s->outcome == HIDDEN_RIGHT;
    add(&share[ANY_WRONG], wrong);
    if (s->drop >= VISIBLE) {
        add(&share[WRONG_NAME], wrong);
        add(&share[REPORTED], s->reported);
        add(&share[REFITTED], isfinite(s->margin));
        add(&share[LISTED], s->before < LISTED_SHARE);
    }
    if (s->drop >= LARGE)
        add(&share[s->shapes ? NAMED : FREQUENCIES], named);
    if (s->margin >= CLEAR_MARGIN)
        add(&share[CLEARLY_NAMED], named || (s->outcome == HIDDEN_IN_SET && s->nset <= 2));
}

static void add_case(const struct hidden_score *s, struct power_share share[LINES])
{
    static const int line[] = {[HIDDEN_OF_MODEL] = COVERAGE, [HIDDEN_OF_CAUSE] = CAUSE_COVERAGE, [HIDDEN_OF_MIXTURE] = MIXTURE};
    int wrong = s->outcome == HIDDEN_WRONG;
    add(&share[DIAGNOSED], s->outcome != HIDDEN_FAILED);
    if (s->outcome == HIDDEN_FAILED)
        return;
    for (int v = 0; v < s->nvalue; v++)
        if (s->value[v].of != HIDDEN_OF_MIXTURE || s->class != HIDDEN_OUTSIDE)
            add(&share[line[s->value[v].of]], hidden_covers(&s->value[v]));
        else
            add(&share[OUTSIDE_MIXTURE], hidden_covers(&s->value[v]));
    if (s->class != HIDDEN_DATA && s->class != HIDDEN_NOISE) {
        add(&share[ACCUSED], s->channels > 0);
        add(&share[ACCUSED_ANY], s->accused > 0);
    }
    switch (s->class) {
    case HIDDEN_NOTHING:
        add(&share[s->coloured ? COLOURED_ALARM : FALSE_ALARM], s->outcome != HIDDEN_SILENT);
        break;
    case HIDDEN_PHYSICAL:
        add_physical(s, share);
        break;
    case HIDDEN_PAIR:
        add(&share[PAIR_ANY_WRONG], wrong);
        if (s->lesser >= LARGE) {
            int both = s->outcome == HIDDEN_RIGHT && s->names > 1;
            add(&share[PAIR_BOTH], both);
            if (s->shapes)
                add(&share[PAIR_SHAPES], both);
            add(&share[PAIR_WRONG], wrong);
        }
        break;
    case HIDDEN_DATA:
        add(&share[DATA_PHYSICAL], s->names > 0);
        if (s->drop >= VISIBLE)
            add(&share[WRONG_NAME], wrong);
        if (s->drop >= CLEAR_LEFT)
            add(&share[DATA_FOUND], s->outcome == HIDDEN_RIGHT);
        break;
    case HIDDEN_NOISE:
        add(&share[NOISE_NAME], s->names > 0);
        break;
    case HIDDEN_OUTSIDE:
        add(&share[OUTSIDE_NO_NAME], s->names == 0);
        if (s->left >= CLEAR_LEFT)
            add(&share[OUTSIDE_LEFT], s->names == 0);
        break;
    case HIDDEN_CLASSES:
        break;
    }
}

static void show_bounds(FILE *out, double least, double most)
{
    if (least > 0 && most < 1)
        fprintf(out, "  required %g to %g %%", 100 * least, 100 * most);
    else
        fprintf(out, "  required at %s %g %%", least > 0 ? "least" : "most", 100 * (least > 0 ? least : most));
}

int power_requirements(FILE *out, int count, const struct power_result *result)
{
    struct power_share share[LINES] = {{0, 0}};
    int missed = 0;
    for (int i = 0; i < count; i++)
        if (result[i].done)
            add_case(&result[i].score, share);
    fprintf(out, "\nrequired\n");
    for (int i = 0; i < LINES; i++) {
        double lower, upper, part = share[i].count ? (double)share[i].right / share[i].count : 0;
        power_interval(share[i], &lower, &upper);
        int holds =
            table[i].bad ? part <= table[i].most && upper >= table[i].least : part >= table[i].least && lower <= table[i].most;
        if (i == REQUIRED)
            fprintf(out, "beside that\n");
        if (!share[i].count) {
            fprintf(out, "  %-50s no case\n", table[i].text);
            continue;
        }
        fprintf(out, "  %-50s %4d of %-4d %5.1f %% (%.1f to %.1f)", table[i].text, share[i].right, share[i].count, 100 * part,
                100 * lower, 100 * upper);
        if (i < REQUIRED) {
            show_bounds(out, table[i].least, table[i].most);
            fprintf(out, "  %s", holds ? "PASS" : "FAIL");
            missed |= !holds;
        }
        fprintf(out, "\n");
    }
    return missed;
}
