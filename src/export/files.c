#include <errno.h>
#include <sys/stat.h>

#include "export/export.h"

#define LONGEST 4096 /* characters of a remark; what is beyond is cut */

/* `length` characters of text on lines of their own, those behind the first indented by two */
static void put_broken(const struct remark *remark, const char *text, size_t length)
{
    size_t room = (size_t)remark->width - strlen(remark->mark);
    for (int line = 0; length; line++) {
        size_t most = line ? room - 2 : room, take = length;
        if (length > most) {
            for (take = most; take && text[take] != ' ';)
                take--;
            take = take ? take : most;
        }
        (void)fprintf(remark->stream, "%s%s%.*s\n", remark->mark, line ? "  " : "", (int)take, text);
        for (; take < length && text[take] == ' ';)
            take++;
        text += take;
        length -= take;
    }
}

void remark_put(const struct remark *remark, const char *format, ...)
{
    char text[LONGEST];
    va_list list;
    va_start(list, format);
    int length = vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (length < 0)
        return;
    for (char *c = text; *c; c++)
        if (*c < ' ' || *c > '~')
            *c = '?';
    if (*text)
        put_broken(remark, text, strlen(text));
    else
        (void)fprintf(remark->stream, "%.*s\n", (int)strcspn(remark->mark, " "), remark->mark);
}

/* A name as one word: other characters than letters, digits and _ . - become '_'. */
static void remark_word(FILE *stream, const char *name)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
    for (; name && *name; name++)
        (void)fputc(strchr(plain, *name) ? *name : '_', stream);
}

/* The shortest decimal number that is read back as the same double; text [32]. */
static const char *remark_number(double value, char *text)
{
    for (int digits = 6; digits <= 17; digits++) { /* from 6, so that 7850 is not 7.85e+03 */
        (void)snprintf(text, 32, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    return text;
}

static void put_frequencies(const struct remark *remark, const char *what, int count, const double *hz)
{
    char text[LONGEST];
    int length = snprintf(text, sizeof text, "%s [Hz]:", what);
    for (int i = 0; i < count && isfinite(hz[i]) && length > 0 && length < LONGEST; i++) /* few masters have few modes */
        length += snprintf(text + length, LONGEST - (size_t)length, "%s %.10g", i ? "," : "", hz[i]);
    remark_put(remark, "%s", text);
}

/* What the model has: parameters of *IDENTIFY with their values there. */
static double export_parameter(const struct export_model *model, int p)
{
    return *parameter_value(model->discrete->rotor, model->job->unknowns.parameter[p]);
}

/* Standard deviation, NaN where it was not identified. */
static double export_parameter_std(const struct export_model *model, int p)
{
    return model->identified ? model->identified->fit->std[p] : NAN;
}

static void put_origin(const struct remark *remark, const struct export_model *model)
{
    const struct job *job = model->job;
    if (model->identified) {
        const rotid_fit_result *fit = model->identified->fit;
        remark_put(remark, "Identified from %d measured modes, %s, REDUCTION=%s: %s.", job->measurement.nmode,
                   functional_words[job->options.fit.functional], reduction_words[job->options.fit.reduction],
                   !fit->converged         ? "NOT CONVERGED, not to be trusted"
                   : fit->any_at_bound     ? "AT A BOUND, not to be trusted"
                   : fit->any_undetermined ? "NOT DETERMINED by the data, not to be trusted"
                                           : "converged");
    } else {
        remark_put(remark, "As the deck states it: nothing was fitted.");
    }
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        const char *unit = job->unknowns.bounds[p].unit;
        double std = export_parameter_std(model, p);
        char value[32];
        (void)remark_number(export_parameter(model, p), value);
        unit = unit && strcmp(unit, "1") ? unit : "";
        if (isfinite(std))
            remark_put(remark, "%s = %s%s%s, standard deviation %.3g", job->unknowns.bounds[p].name, value, *unit ? " " : "",
                       unit, std);
        else
            remark_put(remark, "%s = %s%s%s", job->unknowns.bounds[p].name, value, *unit ? " " : "", unit);
    }
}

static void put_causes(const struct remark *remark, const struct rotor *rotor)
{
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *effect = &rotor->effect[i];
        char text[512];
        int length = snprintf(text, sizeof text, "Part of the model: cause %s, %s", effect->name, effect->kind->id);
        for (int p = 0; p < effect_parameters(effect) && length > 0 && length < (int)sizeof text; p++)
            length += snprintf(text + length, sizeof text - (size_t)length, ", %s %.10g [%s]", effect->kind->parameter[p].name,
                               effect->value[p], effect->kind->parameter[p].unit);
        remark_put(remark, "%s", text);
    }
}

/* Deck, its heading, version, units, where the values come from, parameters, causes, mass, frequencies. */
static void remark_model(const struct remark *remark, const struct export_model *model)
{
    const struct spectrum *s = &model->spectrum;
    remark_put(remark, "Bending of a rotor in one plane, written by rotid %s from %s", model->version, model->job->deck);
    for (int i = 0; i < model->job->nheading; i++)
        remark_put(remark, "%s", model->job->heading[i]);
    remark_put(remark, "Units: m, kg, s, N.");
    put_origin(remark, model);
    put_causes(remark, model->discrete->rotor);
    remark_put(remark, "mass %.10g kg, centre of mass at %.10g m", model->mass.mass, model->mass.center);
    if (s->nrigid)
        put_frequencies(remark, "Modes on the supports, or of free motion", s->nrigid, s->rigid_hz);
    put_frequencies(remark, "Bending modes", s->count, s->full_hz);
}

/* What it is condensed onto, and the frequencies then. */
static void remark_condensed(const struct remark *remark, const struct export_model *model)
{
    const struct export_condensed *c = &model->condensed;
    remark_put(remark, "Condensed by %s onto the lateral deflection of %d %s:", c->kind == ROTID_IRS ? "IRS" : "GUYAN", c->count,
               model->job->rotor.nsensor ? "sensors" : "nodes");
    put_frequencies(remark, "Bending modes of the condensed model", model->spectrum.count, model->spectrum.reduced_hz);
}

#define DMIG_LINE_WIDTH 72 /* Nastran reads comments as far as column 80 */

double dmig_number(double value, char *text)
{
    char number[32];
    for (int digits = 12; digits > 0; digits--) {
        (void)snprintf(number, sizeof number, "%.*E", digits, value);
        char *exponent = strchr(number, 'E');
        long power = exponent ? strtol(exponent + 1, NULL, 10) : 0;
        if (exponent && exponent - number + snprintf(NULL, 0, "D%+ld", power) <= 16) {
            (void)snprintf(text, 17, "%.*sD%+ld", (int)(exponent - number), number, power);
            break;
        }
    }
    return strtod(number, NULL);
}

/* Either kind of matrix: entry (row, column) of `full`, or of `dense` with n rows, in the order of the lower triangle. */
struct source {
    const rotid_matrix *full;
    const double *dense;
    int n;
};

static int next_entry(const struct source *source, struct triplet *t)
{
    if (source->full)
        return triplet_next(source->full, t);
    while (t->column < source->n) {
        t->row = t->row < t->column ? t->column : t->row + 1;
        if (t->row >= source->n) {
            t->column++;
            t->row = -1;
            continue;
        }
        t->value = source->dense[t->row + (ptrdiff_t)t->column * source->n];
        if (t->value != 0)
            return 1;
    }
    return 0;
}

struct writer {
    FILE *stream;
    const struct export_model *model;
    struct source source;
};

/* Its GRID, its component, and the sign of the rotation there: 1 for v, -1 for theta. */
static int grid_of(const struct writer *w, int dof, int *component, int *sign)
{
    int rotation = w->source.full && dof % 2;
    *component = rotation ? 5 : 1;
    *sign = rotation ? -1 : 1;
    return w->source.full ? dof / 2 + 1 : export_master_id(w->model, dof);
}

/* The number that goes into the main matrix, or into the remainder; 0 where there is none to write. */
static int split(double value, int remainder, char *text)
{
    double main = dmig_number(value, text);
    if (remainder && value - main != 0)
        (void)dmig_number(value - main, text);
    return !remainder || value - main != 0;
}

static long count_remainders(const struct source *source)
{
    char text[17];
    long count = 0;
    for (struct triplet t = {.row = -1}; next_entry(source, &t);)
        count += split(t.value, 1, text);
    return count;
}

/* Header and columns of one matrix. */
static void put_matrix(const struct writer *w, const char *name, int remainder)
{
    char text[17];
    int column = -1, row_component, row_sign, column_component, column_sign;
    (void)fprintf(w->stream, "DMIG    %-8s%8d%8d%8d%8d\n", name, 0, 6, 2, 0);
    for (struct triplet t = {.row = -1}; next_entry(&w->source, &t);) {
        int row = grid_of(w, t.row, &row_component, &row_sign), grid = grid_of(w, t.column, &column_component, &column_sign);
        if (!split(row_sign * column_sign * t.value, remainder, text))
            continue;
        if (t.column != column)
            (void)fprintf(w->stream, "DMIG*   %-16s%16d%16d\n", name, grid, column_component);
        (void)fprintf(w->stream, "*       %16d%16d%16s\n", row, row_component, text);
        column = t.column;
    }
}

static void put_grid(FILE *stream, int id, double z)
{
    char text[32];
    for (int decimals = 14; decimals > 0 && snprintf(text, sizeof text, "%.*f", decimals, z) > 16;)
        decimals--;
    (void)fprintf(stream, "GRID*   %16d%16s%16s%16s\n*       %16s\n", id, "", "0.0", "0.0", text);
}

static void put_case(FILE *stream, const struct export_model *model, const char *const *name, const int *remainder)
{
    int modes = model->spectrum.nrigid + model->spectrum.count;
    (void)fputs("SOL 103\nCEND\nTITLE = BENDING OF A ROTOR IN ONE PLANE, FROM ROTID\nECHO = NONE\nMETHOD = 1\nSPC = 1\n", stream);
    (void)fprintf(stream, "K2GG = %s%s%s\n", name[0], remainder[0] ? ", " : "", remainder[0] ? name[1] : "");
    (void)fprintf(stream, "M2GG = %s%s%s\n", name[2], remainder[1] ? ", " : "", remainder[1] ? name[3] : "");
    (void)fprintf(stream, "DISPLACEMENT = ALL\nBEGIN BULK\nEIGRL   %8d%8s%8s%8d\n", 1, "", "", modes);
}

static void put_remarks(FILE *stream, const struct export_model *model, int condensed)
{
    struct remark remark = {stream, "$ ", DMIG_LINE_WIDTH};
    remark_model(&remark, model);
    if (condensed)
        remark_condensed(&remark, model);
    remark_put(&remark, "%s", "");
    remark_put(&remark, "One bending plane, x-z: T1 = v%s; all else is held.", condensed ? "" : ", R2 = dv/dz = -theta of rotid");
    remark_put(&remark, "%s",
               condensed ? "A GRID is a sensor and has its id; without sensors it is a node of the axis, from 1."
                         : "GRID i is node i: first those of the axis, then inner nodes of rods and bars.");
    remark_put(&remark, "%s",
               "Sixteen columns hold 10 to 12 digits: the matrices that end in R hold the rest, and the sum of both is "
               "the matrix of rotid to the last bit. A program that takes one name after K2GG only must not run this.");
}

static int write_deck(struct writer *w, int condensed, const char *const *name, const struct source *mass)
{
    FILE *stream = w->stream;
    const struct export_model *model = w->model;
    const struct source stiffness = w->source;
    const int remainder[2] = {count_remainders(&stiffness) > 0, count_remainders(mass) > 0};
    int count = condensed ? stiffness.n : model->nnode;
    put_remarks(stream, model, condensed);
    put_case(stream, model, name, remainder);
    for (int i = 0; i < count; i++)
        put_grid(stream, condensed ? export_master_id(model, i) : i + 1,
                 condensed ? model_master_z(model->discrete, i) : model->node[i].z);
    if (!condensed)
        (void)fprintf(stream, "SPC1    %8d%8d%8d%8s%8d\n", 1, 2346, 1, "THRU", count);
    for (int i = 0; i < count && condensed; i++)
        (void)fprintf(stream, "SPC1    %8d%8d%8d\n", 1, 23456, export_master_id(model, i));
    put_matrix(w, name[0], 0);
    if (remainder[0])
        put_matrix(w, name[1], 1);
    w->source = *mass;
    put_matrix(w, name[2], 0);
    if (remainder[1])
        put_matrix(w, name[3], 1);
    (void)fputs("ENDDATA\n", stream);
    return ROTID_OK;
}

int dmig_full(FILE *stream, const struct export_model *model)
{
    static const char *const name[] = {"KFULL", "KFULLR", "MFULL", "MFULLR"};
    const struct source mass = {.full = &model->m};
    struct writer w = {.stream = stream, .model = model, .source.full = &model->k};
    return write_deck(&w, 0, name, &mass);
}

int dmig_condensed(FILE *stream, const struct export_model *model)
{
    static const char *const name[] = {"KRED", "KREDR", "MRED", "MREDR"};
    const struct source mass = {.dense = model->condensed.m, .n = model->condensed.count};
    struct writer w = {stream, model, {.dense = model->condensed.k, .n = model->condensed.count}};
    return write_deck(&w, 1, name, &mass);
}

#define LINE_WIDTH 120 /* the format allows 1,024 */

static struct remark begin(FILE *stream, const struct export_model *model, const char *form, const char *what)
{
    struct remark remark = {stream, "% ", LINE_WIDTH};
    (void)fprintf(stream, "%%%%MatrixMarket matrix %s real symmetric\n", form);
    remark_put(&remark, "%s", what);
    remark_model(&remark, model);
    return remark;
}

/* How many there are. */
static long triplet_count(const rotid_matrix *a)
{
    long count = 0;
    for (struct triplet t = {.row = -1}; triplet_next(a, &t);)
        count++;
    return count;
}

static int write_full(FILE *stream, const struct export_model *model, const rotid_matrix *a, const char *what)
{
    struct remark remark = begin(stream, model, "coordinate", what);
    if (model->is_solid)
        remark_put(
            &remark,
            "Lower triangle. Rows are U, V, W [m] of the nodes of a solid of revolution that bends: u_r = U cos t, u_t = V "
            "sin t, u_z = W cos t; on the axis V = -U and W = 0. Those of rods and bars beside it are v [m] and theta [rad] "
            "= -dv/dz. Which row is which, and where, stands in the file NAME.nodes.csv beside this one; in the row of a "
            "sensor U is that of the surface at the sensor.");
    else
        remark_put(&remark,
                   "Lower triangle. Rows 2 i - 1 and 2 i are v [m] and theta [rad] of node i = 1 ... %d, theta = -dv/dz; their "
                   "positions stand in the file NAME.nodes.csv beside this one.",
                   a->n / 2);
    (void)fprintf(stream, "%d %d %ld\n", a->n, a->n, triplet_count(a));
    for (struct triplet t = {.row = -1}; triplet_next(a, &t);)
        (void)fprintf(stream, "%d %d %.17g\n", t.row + 1, t.column + 1, t.value);
    return ROTID_OK;
}

int matrix_market_stiffness(FILE *stream, const struct export_model *model)
{
    return write_full(stream, model, &model->k, "Stiffness matrix [N/m, N, N.m]");
}

int matrix_market_mass(FILE *stream, const struct export_model *model)
{
    return write_full(stream, model, &model->m, "Mass matrix [kg, kg.m, kg.m2]");
}

static int write_condensed(FILE *stream, const struct export_model *model, const double *a, const char *what)
{
    int n = model->condensed.count;
    struct remark remark = begin(stream, model, "array", what);
    remark_condensed(&remark, model);
    for (int i = 0; i < n; i++)
        remark_put(&remark, "row %d: %s %d at %.10g m", i + 1, model->job->rotor.nsensor ? "sensor" : "node",
                   export_master_id(model, i), model_master_z(model->discrete, i));
    (void)fprintf(stream, "%d %d\n", n, n);
    for (int j = 0; j < n; j++)
        for (int i = j; i < n; i++)
            (void)fprintf(stream, "%.17g\n", a[i + (ptrdiff_t)j * n]);
    return ROTID_OK;
}

int matrix_market_condensed_stiffness(FILE *stream, const struct export_model *model)
{
    return write_condensed(stream, model, model->condensed.k, "Condensed stiffness matrix [N/m]");
}

int matrix_market_condensed_mass(FILE *stream, const struct export_model *model)
{
    return write_condensed(stream, model, model->condensed.m, "Condensed mass matrix [kg]");
}

/* node, z_m, row_v, row_theta (from 1), member, sensor; of a solid node, r_m, z_m, row_u, row_v, row_w, row_theta, member, sensor
 */
static int matrix_market_nodes(FILE *stream, const struct export_model *model)
{
    int solid = model->is_solid;
    (void)fprintf(stream, solid ? "node,r_m,z_m,row_u,row_v,row_w,row_theta,member,sensor\n"
                                : "node,z_m,row_v,row_theta,member,sensor\n");
    for (int i = 0; i < model->nnode; i++) {
        const struct export_node *node = &model->node[i];
        (void)fprintf(stream, "%d,", i + 1);
        if (isfinite(node->r))
            (void)fprintf(stream, "%.17g", node->r);
        (void)fprintf(stream, solid ? ",%.17g," : "%.17g,", node->z);
        for (int c = 0; c < (solid ? 4 : 2); c++)
            (void)fprintf(stream, node->row[c] ? "%d," : ",", node->row[c]);
        remark_word(stream, node->member);
        (void)fprintf(stream, node->sensor ? ",%d\n" : ",\n", node->sensor);
    }
    return ROTID_OK;
}

/* of Matrix Market, those of the condensed model last */
static const struct {
    const char *suffix;
    int (*write)(FILE *stream, const struct export_model *model);
} market[EXPORT_MOST_FILES] = {{"stiffness.mtx", matrix_market_stiffness},
                               {"mass.mtx", matrix_market_mass},
                               {"nodes.csv", matrix_market_nodes},
                               {"condensed_stiffness.mtx", matrix_market_condensed_stiffness},
                               {"condensed_mass.mtx", matrix_market_condensed_mass}};

int export_files_name(struct pool *pool, enum export_format format, int condensed, const char *path,
                      const struct export_model *model, struct export_files *files)
{
    *files = (struct export_files){format, condensed, 1, {path}};
    if (format != EXPORT_MATRIX_MARKET)
        return ROTID_OK;
    files->count = model->condensed.impossible ? EXPORT_MOST_FILES - 2 : EXPORT_MOST_FILES;
    for (int i = 0; i < files->count; i++)
        if (!(files->path[i] = pool_format(pool, "%s.%s", path, market[i].suffix)))
            return ROTID_ERROR_MEMORY;
    return ROTID_OK;
}

static int write_one(const struct export_files *files, int i, FILE *stream, const struct export_model *model)
{
    if (files->format == EXPORT_MATRIX_MARKET)
        return market[i].write(stream, model);
    return files->condensed ? dmig_condensed(stream, model) : dmig_full(stream, model);
}

int export_files_write(const struct export_files *files, const struct export_model *model, const char **failed)
{
    struct output output[EXPORT_MOST_FILES];
    int count = 0, status = ROTID_OK, which = 0;
    for (; count < files->count && !status; count++) {
        *failed = files->path[count];
        status = output_open(&output[count], files->path[count]);
        if (status)
            break;
        status = write_one(files, count, output[count].stream, model);
    }
    if (status) {
        for (int i = 0; i < count; i++)
            output_abandon(&output[i]);
        return status;
    }
    status = output_close_all(files->count, output, &which);
    *failed = status ? files->path[which] : NULL;
    return status;
}

/* Frequencies of the model in the files, full or condensed [model->spectrum.count]. */
static const double *exported_hz(const struct export_files *files, const struct export_model *model)
{
    return files->condensed ? model->spectrum.reduced_hz : model->spectrum.full_hz;
}

static const char *state_of(const struct export_model *model)
{
    const rotid_fit_result *fit = model->identified ? model->identified->fit : NULL;
    return !fit ? NULL : !fit->converged ? "not_converged" : fit->any_at_bound ? "at_bound" : "converged";
}

void screen_export(const struct screen *to, const struct result_head *head, const struct export_files *files,
                   const struct export_model *model)
{
    const struct job *job = model->job;
    const struct spectrum *s = &model->spectrum;
    struct table *table = table_open(to->pool, "");
    FILE *out = to->out;
    screen_heading(to, head);
    (void)fprintf(out,
                  model->identified ? "model           identified from %d measured modes\n"
                                    : "model           as the deck states it\n",
                  job->measurement.nmode);
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        double std = export_parameter_std(model, p);
        name_cell(out, 15, job->unknowns.bounds[p].name);
        (void)fprintf(out, " %.6g %s", export_parameter(model, p), job->unknowns.bounds[p].unit);
        if (isfinite(std))
            (void)fprintf(out, ", standard deviation %.3g", std);
        (void)fputc('\n', out);
    }
    (void)fprintf(out, "mass            %.4f kg, centre at %.6f m\n", model->mass.mass, model->mass.center);
    (void)fprintf(out, "matrices        %d nodes, %d degrees of freedom\n", model->nnode, model->k.n);
    if (model->condensed.k)
        (void)fprintf(out, "condensed       by %s onto %d %s\n", reduction_words[model->condensed.kind], model->condensed.count,
                      job->rotor.nsensor ? "sensors" : "nodes");
    for (int j = 0; j < s->count; j++) {
        number_column(table, "mode", NULL, SHOW_COUNT, j + 1);
        number_column(table, "frequency", "Hz", SHOW_FIXED(4), s->full_hz[j]);
        number_column(table, "condensed", "Hz", SHOW_FIXED(4), model->condensed.k ? s->reduced_hz[j] : (double)NAN);
    }
    screen_table(to, table);
    (void)fputc('\n', out);
    for (int i = 0; i < files->count; i++) {
        struct stat about;
        if (stat(files->path[i], &about))
            about.st_size = 0;
        (void)fprintf(out, "%s, %.3g MB\n", files->path[i], (double)about.st_size / 1e6);
    }
}

static struct export_parameter_result *parameters(struct pool *pool, const struct export_model *model)
{
    const struct job *job = model->job;
    struct export_parameter_result *list = POOL_ARRAY(pool, struct export_parameter_result, job->unknowns.nparameter);
    for (int p = 0; p < job->unknowns.nparameter && list; p++)
        list[p] = (struct export_parameter_result){job->unknowns.bounds[p].name, job->unknowns.bounds[p].unit,
                                                   export_parameter(model, p), export_parameter_std(model, p)};
    return list;
}

const struct export_result *export_result_of(struct pool *pool, const struct export_files *files,
                                             const struct export_model *model)
{
    const struct spectrum *s = &model->spectrum;
    struct export_result *out = POOL_NEW(pool, struct export_result);
    if (!out)
        return NULL;
    *out = (struct export_result){
        .format = export_format_words[files->format],
        .nfiles = files->count,
        .model = model->identified ? "identified" : "stated",
        .status = state_of(model),
        .nparameters = model->job->unknowns.nparameter,
        .mass_kg = model->mass.mass,
        .center_of_mass_m = model->mass.center,
        .nodes = model->nnode,
        .degrees_of_freedom = model->k.n,
        .reduction = model->condensed.k ? reduction_words[model->condensed.kind] : NULL,
        .masters = model->condensed.k ? model->condensed.count : ROTID_NONE,
        .nrigid_hz = s->nrigid,
        .rigid_hz = s->rigid_hz,
        .nfull_hz = s->count,
        .full_hz = s->full_hz,
        .parameters = parameters(pool, model),
    };
    const char **list = POOL_ARRAY(pool, const char *, files->count);
    out->exported_hz = exported_hz(files, model);
    out->nexported_hz = s->count;
    for (int i = 0; i < files->count && list; i++)
        list[i] = files->path[i];
    out->files = list;
    return out->parameters && list ? out : NULL;
}
