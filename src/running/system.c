#include "running/running.h"

#define INDEPENDENT 1e-6 /* of the length of a static motion: less is rounding of what the basis has */

struct builder {
    struct pool *pool, scratch;
    struct system *system;
    rotid_matrix k, p, pull, held; /* held: K with springs of the bearings' mean stiffness */
    rotid_matrix loss[2];          /* elastic stiffness times loss factors, and times viscous losses */
    double *attached;              /* [n * attachments] bearings, unbalances, probes */
    int attachments, room;
    struct factor factor;
    int *all;
    double *work;
};

/* The parameters by which the elastic stiffness of a group is E dK/dE + G dK/dG: K is of degree 1 in both. */
static int loss_parameters(const struct machine *machine, const struct rotor *rotor, struct parameter *parameter, double *x)
{
    int count = 0;
    for (int i = 0; i < machine->nloss; i++) {
        const struct material *material = &rotor->group[machine->loss[i].group].material;
        parameter[count] = (struct parameter){.kind = PARAMETER_E, .index = machine->loss[i].group};
        x[count++] = material->e;
        parameter[count] = (struct parameter){.kind = PARAMETER_G, .index = machine->loss[i].group};
        x[count] = material->g;
        count += !material->isotropic;
    }
    return count;
}

static int assemble(struct builder *b, const double *x)
{
    struct system *s = b->system;
    const struct machine *machine = s->machine;
    rotid_matrix structure;
    discrete_structure(&s->discrete, &structure);
    s->n = structure.n;
    int status = matrix_like(b->pool, &structure, &s->m);
    rotid_matrix *const own[] = {&b->k, &b->p, &b->pull, &b->held, &b->loss[0], &b->loss[1]};
    for (int i = 0; i < 6 && !status; i++)
        status = matrix_like(&b->scratch, &structure, own[i]);
    b->work = POOL_ARRAY(&b->scratch, double, 4 * (size_t)s->n);
    if (status || !b->work)
        return ROTID_ERROR_MEMORY;
    discrete_assemble(&s->discrete, x, &b->k, &s->m);
    discrete_gyroscopic(&s->discrete, &b->p);
    for (int i = 0; i < machine->npull; i++)
        discrete_spread(&s->discrete, machine->pull[i].group, machine->pull[i].value * s->values->pull[i], &b->pull);
    rotid_matrix none;
    if (machine->nloss && matrix_like(&b->scratch, &structure, &none))
        return ROTID_ERROR_MEMORY;
    for (int i = 0, p = 0; i < machine->nloss; i++) {
        const struct material *material = &discrete_rotor(&s->discrete)->group[machine->loss[i].group].material;
        rotid_matrix *sum = &b->loss[machine->loss[i].viscous];
        double value = machine->loss[i].value * s->values->loss[i];
        for (int part = 0; part < 2 - material->isotropic; part++, p++) {
            int from, end;
            matrix_zero(&b->held);
            discrete_differentiate(&s->discrete, p, &b->held, &none, &from, &end);
            matrix_combine(1, sum, value * x[p], &b->held, sum);
        }
    }
    return ROTID_OK;
}

static int attach(struct builder *b, int first_spring)
{
    struct system *s = b->system;
    const struct machine *machine = s->machine;
    b->attachments = machine->nbearing + machine->nunbalance + machine->nprobe;
    b->attached = POOL_ARRAY(&b->scratch, double, (size_t)s->n *(size_t)b->attachments);
    if (!b->attached)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < b->attachments; i++)
        discrete_spring_motion(&s->discrete, first_spring + i, b->attached + (ptrdiff_t)s->n * i);
    return ROTID_OK;
}

/* a += s v v' */
static void add_spring(rotid_matrix *a, double stiffness, const double *v)
{
    for (int j = 0; j < a->n; j++)
        for (int i = j; i < a->n && i <= j + a->kd && v[j] != 0; i++)
            if (v[i] != 0)
                matrix_add(a, i, j, stiffness * v[i] * v[j]);
}

static int hold(struct builder *b)
{
    struct system *s = b->system;
    const struct machine *machine = s->machine;
    matrix_combine(1, &b->k, 0, &b->k, &b->held);
    for (int i = 0; i < machine->nbearing; i++) {
        const struct bearing *bearing = &machine->bearing[i];
        const struct coefficients *film = &bearing->film;
        double mean = 0;
        for (int j = 0; j < film->count; j++)
            mean += fmax(0, (film->k[4 * j + XX] + film->k[4 * j + YY]) / 2) / film->count;
        mean = bearing_on_pedestal(bearing, film->speed[0], mean * machine_bearing_factor(machine, s->values, i, 0));
        add_spring(&b->held, mean, b->attached + (ptrdiff_t)s->n * i);
    }
    b->all = POOL_ARRAY(&b->scratch, int, s->n);
    if (!b->all)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < s->n; i++)
        b->all[i] = i;
    if (factor_new(&b->scratch, FACTOR_CHOLESKY, &b->held, s->n, b->all, &b->factor))
        return ROTID_ERROR_MEMORY;
    return factor_compute(&b->factor, &b->held) || factor_is_singular(&b->factor, &b->held) ? ROTID_ERROR_STIFFNESS : ROTID_OK;
}

/* The column v [n] joins the basis, made orthogonal to it in M twice, unless the basis has nearly all of it. */
static void extend(struct builder *b, const double *v)
{
    struct system *s = b->system;
    double *own = s->basis + (ptrdiff_t)s->n * s->columns, *image = s->mass_basis + (ptrdiff_t)s->n * s->columns;
    if (s->columns == b->room)
        return;
    if (v != own)
        memcpy(own, v, (size_t)s->n * sizeof *own);
    matrix_multiply(&s->m, 1, own, image);
    double whole = product_dot(s->n, own, image);
    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < s->columns; j++) {
            double part = product_dot(s->n, s->mass_basis + (ptrdiff_t)s->n * j, own);
            for (int i = 0; i < s->n; i++)
                own[i] -= part * s->basis[i + (ptrdiff_t)s->n * j];
        }
        matrix_multiply(&s->m, 1, own, image);
        double left = product_dot(s->n, own, image);
        if (!(left > INDEPENDENT * INDEPENDENT * whole))
            return;
        for (int i = 0; i < s->n; i++) {
            own[i] /= sqrt(left);
            image[i] /= sqrt(left);
        }
        whole = 1;
    }
    s->columns++;
}

/* The static motion by forces f [n]. */
static void extend_static(struct builder *b, const double *force)
{
    memcpy(b->work, force, (size_t)b->system->n * sizeof *b->work);
    factor_solve(&b->factor, 1, b->work);
    extend(b, b->work);
}

/* By the parts of the unbalance that act as one, whatever its size: what grades permit follows the mass, what is stated does not.
 */
static void extend_unbalance(struct builder *b, double *force)
{
    const struct system *s = b->system;
    const double *planes = b->attached + (ptrdiff_t)s->n * s->machine->nbearing;
    for (int part = 0; part < 4; part++) {
        memset(force, 0, (size_t)s->n * sizeof *force);
        for (int u = 0; u < s->machine->nunbalance; u++) {
            const struct unbalance *own = &s->machine->unbalance[u];
            double size = (own->grade > 0) == part / 2 ? own->value * (part % 2 ? sin(own->phase) : cos(own->phase)) : 0;
            for (int i = 0; i < s->n && size != 0; i++)
                force[i] += size * planes[i + (ptrdiff_t)s->n * u];
        }
        extend_static(b, force);
    }
}

static void weigh(struct builder *b)
{
    struct system *s = b->system;
    double *rigid = b->work + 2 * (ptrdiff_t)s->n, *force = b->work + s->n;
    discrete_rigid_motions(&s->discrete, rigid);
    matrix_multiply(&s->m, 1, rigid, force);
    s->total_mass = product_dot(s->n, rigid, force);
}

/* Modes at rest on springs of the mean stiffness of the bearings, and the static motions by what else acts on the rotor. */
static int make_basis(struct builder *b, const struct basis_size *size)
{
    struct system *s = b->system;
    int modes = size->modes < s->n ? size->modes : s->n, coupled = size->coupled < modes ? size->coupled : modes;
    const rotid_matrix *acts[] = {&b->p, &b->pull, &b->loss[0], &b->loss[1]};
    int kinds = size->all ? 4 : 1;
    struct eigen_full eigen;
    b->room = modes + (modes < s->n ? s->machine->nbearing + 5 + kinds * coupled : 0);
    b->room = b->room < s->n ? b->room : s->n;
    double *lambda = POOL_ARRAY(&b->scratch, double, modes);
    s->basis = POOL_ARRAY(b->pool, double, (size_t)s->n *(size_t)(b->room + 1));
    s->mass_basis = POOL_ARRAY(b->pool, double, (size_t)s->n *(size_t)(b->room + 1));
    if (!lambda || !s->basis || !s->mass_basis || eigen_full_new(&b->scratch, &b->held, modes, &eigen))
        return ROTID_ERROR_MEMORY;
    int status = eigen_full_solve(&eigen, &b->held, &s->m, lambda, s->basis);
    if (status)
        return status;
    s->columns = modes;
    s->highest = sqrt(fmax(0, lambda[modes - 1]));
    matrix_multiply(&s->m, modes, s->basis, s->mass_basis);
    double *force = b->work + s->n;
    weigh(b);
    extend_static(b, force);
    for (int i = 0; i < s->machine->nbearing; i++)
        extend_static(b, b->attached + (ptrdiff_t)s->n * i);
    extend_unbalance(b, force);
    for (int kind = 0; kind < kinds; kind++) {
        for (int j = 0; j < coupled; j++) {
            matrix_multiply(acts[kind], 1, s->basis + (ptrdiff_t)s->n * j, force);
            extend_static(b, force);
        }
    }
    return ROTID_OK;
}

/* a [columns^2] := V' A V */
static int project(struct builder *b, const rotid_matrix *a, double **to)
{
    struct system *s = b->system;
    double *image = POOL_ROOM(&b->scratch, double, (size_t)s->n *(size_t)s->columns);
    *to = POOL_ARRAY(b->pool, double, (size_t)s->columns *(size_t)s->columns);
    if (!image || !*to)
        return ROTID_ERROR_MEMORY;
    matrix_multiply(a, s->columns, s->basis, image);
    product_transposed(s->columns, s->columns, s->n, s->basis, image, *to);
    return ROTID_OK;
}

static int take_basis(struct builder *b, const struct system *from)
{
    struct system *s = b->system;
    s->columns = from->columns;
    s->highest = from->highest;
    s->basis = from->basis;
    s->mass_basis = POOL_ARRAY(b->pool, double, (size_t)s->n *(size_t)s->columns);
    if (!s->mass_basis)
        return ROTID_ERROR_MEMORY;
    matrix_multiply(&s->m, s->columns, s->basis, s->mass_basis);
    weigh(b);
    return project(b, &s->m, &s->own_mass);
}

static int project_all(struct builder *b)
{
    struct system *s = b->system;
    const struct machine *machine = s->machine;
    matrix_combine(1, &b->k, -1, &b->pull, &b->k);
    int status = project(b, &b->k, &s->k), places = discrete_places(&s->discrete);
    if (!status)
        status = project(b, &b->p, &s->p);
    for (int i = 0; i < 2 && machine->nloss && !status; i++)
        status = project(b, &b->loss[i], &s->loss[i]);
    s->bearing = POOL_ARRAY(b->pool, double, (size_t)s->columns *(size_t)(b->attachments + 1));
    s->axis = POOL_ARRAY(b->pool, double, (size_t)s->columns *(size_t)places);
    s->weight = POOL_ARRAY(b->pool, double, s->columns);
    if (status || !s->bearing || !s->axis || !s->weight)
        return ROTID_ERROR_MEMORY;
    s->naxis = places;
    s->unbalance = s->bearing + (ptrdiff_t)s->columns * machine->nbearing;
    s->probe = s->unbalance + (ptrdiff_t)s->columns * machine->nunbalance;
    if (b->attachments)
        product_transposed(s->columns, b->attachments, s->n, s->basis, b->attached, s->bearing);
    for (int j = 0; j < s->columns; j++) {
        s->weight[j] = product_dot(s->n, s->mass_basis + (ptrdiff_t)s->n * j, b->work + 2 * (ptrdiff_t)s->n);
        for (int i = 0; i < places; i++)
            s->axis[j + (ptrdiff_t)s->columns * i] = s->basis[discrete_place_dof(&s->discrete, i) + (ptrdiff_t)s->n * j];
    }
    return ROTID_OK;
}

static double largest(const struct coefficients *all)
{
    double most = 0;
    for (int i = 0; i < all->count; i++)
        most = fmax(most, fmax(fabs(all->k[4 * i + XX]), fabs(all->k[4 * i + YY])));
    return most;
}

/* Of the film and the pedestal of a bearing the stiffer one gives way by the unknown alone, the other one by v' V q less that. */
static int film_stands_alone(const struct bearing *bearing)
{
    return largest(&bearing->film) > largest(&bearing->pedestal);
}

enum part { FILM, PEDESTAL };

/* a += factor [xx xy; yx yy] on what a part of a bearing gives way in both planes; at: the unknown behind the basis, -1: none. */
static void add_bearing(const struct system *s, int bearing, int at, enum part part, const double value[4], double factor,
                        double *a)
{
    const double *v = s->bearing + (ptrdiff_t)s->columns * bearing;
    int alone = at >= 0 && (part == FILM) == film_stands_alone(&s->machine->bearing[bearing]);
    int first = alone ? s->columns : 0, behind = s->columns + (at >= 0);
    double end = alone ? 1 : -1;
    for (int plane = 0; plane < 2; plane++)
        for (int other = 0; other < 2; other++) {
            double f = factor * value[2 * plane + other];
            double *block = a + (plane + (ptrdiff_t)s->size * other) * s->plane;
            for (int j = first; j < behind && f != 0; j++) {
                double right = f * (j < s->columns ? v[j] : end);
                double *column = block + (ptrdiff_t)s->size * (j < s->columns ? j : at);
                for (int i = first; i < behind; i++)
                    column[i < s->columns ? i : at] += right * (i < s->columns ? v[i] : end);
            }
        }
}

static int open_dense(struct pool *pool, struct system *s)
{
    const struct machine *machine = s->machine;
    int pedestals = 0;
    for (int i = 0; i < machine->nbearing; i++)
        pedestals += machine->bearing[i].pedestal.count > 0;
    for (int i = 0; i < machine->nloss; i++)
        s->hysteretic |= !machine->loss[i].viscous;
    s->plane = s->columns + pedestals;
    s->size = 2 * s->plane;
    size_t square = (size_t)s->size * (size_t)s->size;
    double *real = POOL_ARRAY(pool, double, 7 * square);
    s->d = POOL_ARRAY(pool, double complex, square + 2 * (size_t)s->size);
    for (int i = 0; i < 2; i++)
        if (pair_new(pool, s->size, &s->spare[i]))
            return ROTID_ERROR_MEMORY;
    s->pivot = POOL_ARRAY(pool, int, s->size);
    if (!real || !s->d || !s->pivot)
        return ROTID_ERROR_MEMORY;
    s->mass = real;
    s->c = real + square;
    s->stiff = real + 2 * square;
    s->dc = real + 3 * square;
    s->dk = real + 4 * square;
    s->h = real + 5 * square;
    s->turn = real + 6 * square;
    s->right = s->d + square;
    s->left = s->right + s->size;
    for (int plane = 0; plane < 2; plane++) {
        int first = plane * s->plane, at = s->columns;
        for (int j = 0; j < s->columns; j++)
            for (int i = 0; i < s->columns; i++)
                s->mass[first + i + (ptrdiff_t)s->size * (first + j)] =
                    s->own_mass ? s->own_mass[i + (ptrdiff_t)s->columns * j] : i == j;
        for (int i = 0; i < machine->nbearing; i++)
            if (machine->bearing[i].pedestal.count) {
                const double m[4] = {machine->bearing[i].m[plane]};
                add_bearing(s, i, at++, PEDESTAL, m, 1, s->mass + first * (ptrdiff_t)(s->size + 1));
            }
    }
    return ROTID_OK;
}

static int build(struct builder *b, const struct job *job, const struct system *built, const struct basis_size *basis,
                 int *failed)
{
    struct system *s = b->system;
    struct rotor rotor;
    struct parameter *parameter = POOL_ARRAY(b->pool, struct parameter, 2 * s->machine->nloss);
    double *x = POOL_ARRAY(b->pool, double, 2 * s->machine->nloss + 1);
    int status = parameter && x ? machine_rotor(b->pool, s->machine, job, s->values, &rotor) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    int count = loss_parameters(s->machine, &rotor, parameter, x),
        first = rotor.nspring - s->machine->nbearing - s->machine->nunbalance - s->machine->nprobe;
    enum discretisation as = job->options.solid ? AS_SOLID : AS_BEAM;
    status = built ? discrete_of_shape(b->pool, &built->discrete, &rotor, count, parameter, &s->discrete)
                   : discrete_build(b->pool, as, &rotor, count, parameter, 1, &s->discrete, failed);
    if (!status)
        status = assemble(b, x);
    if (!status)
        status = attach(b, first);
    if (!status && basis)
        status = hold(b);
    if (!status)
        status = basis ? make_basis(b, basis) : built ? take_basis(b, built) : ROTID_ERROR_ARGUMENT;
    if (!status)
        status = project_all(b);
    return status ? status : open_dense(b->pool, s);
}

int system_build(struct pool *pool, const struct machine *machine, const struct job *job, const struct machine_values *values,
                 const struct system *built, const struct basis_size *basis, struct system *system, int *failed)
{
    struct builder b = {.pool = pool, .system = system};
    *system = (struct system){.machine = machine, .values = values, .speed = NAN};
    *failed = -1;
    pool_open(&b.scratch, pool->allocator);
    int status = build(&b, job, built, basis, failed);
    pool_close(&b.scratch);
    return status;
}

/* ---- at a speed */

static void add_block(const struct system *s, double factor, const double *value, int row, int column, double *a)
{
    double *block = a + (row + (ptrdiff_t)s->size * column) * s->plane;
    for (int j = 0; j < s->columns; j++)
        for (int i = 0; i < s->columns; i++)
            block[i + (ptrdiff_t)s->size * j] += factor * value[i + (ptrdiff_t)s->columns * j];
}

void system_at(struct system *s, double speed)
{
    const struct machine *machine = s->machine;
    size_t square = (size_t)s->size * (size_t)s->size;
    if (speed == s->speed)
        return;
    s->speed = speed;
    memset(s->c, 0, 6 * square * sizeof *s->c);
    for (int plane = 0; plane < 2; plane++)
        add_block(s, 1, s->k, plane, plane, s->stiff);
    add_block(s, speed, s->p, 0, 1, s->c);
    add_block(s, -speed, s->p, 1, 0, s->c);
    add_block(s, 1, s->p, 0, 1, s->dc);
    add_block(s, -1, s->p, 1, 0, s->dc);
    for (int viscous = 0; viscous < 2 && machine->nloss; viscous++) {
        const double *loss = s->loss[viscous], rate = viscous ? speed : 1;
        double *turn = viscous ? s->stiff : s->turn;
        for (int plane = 0; plane < 2; plane++)
            add_block(s, 1, loss, plane, plane, viscous ? s->c : s->h);
        add_block(s, rate, loss, 0, 1, turn);
        add_block(s, -rate, loss, 1, 0, turn);
    }
    if (machine->nloss) {
        add_block(s, 1, s->loss[1], 0, 1, s->dk);
        add_block(s, -1, s->loss[1], 1, 0, s->dk);
    }
    for (int i = 0, pedestal = 0; i < machine->nbearing; i++) {
        const struct bearing *bearing = &machine->bearing[i];
        double k[4], c[4], dk[4], dc[4];
        int at = bearing->pedestal.count ? s->columns + pedestal++ : -1;
        double of_k = machine_bearing_factor(machine, s->values, i, 0), of_c = machine_bearing_factor(machine, s->values, i, 1);
        coefficients_at(&bearing->film, speed, k, c, dk, dc);
        add_bearing(s, i, at, FILM, k, of_k, s->stiff);
        add_bearing(s, i, at, FILM, c, of_c, s->c);
        add_bearing(s, i, at, FILM, dk, of_k, s->dk);
        add_bearing(s, i, at, FILM, dc, of_c, s->dc);
        if (at < 0)
            continue;
        coefficients_at(&bearing->pedestal, speed, k, c, dk, dc);
        add_bearing(s, i, at, PEDESTAL, k, 1, s->stiff);
        add_bearing(s, i, at, PEDESTAL, c, 1, s->c);
        add_bearing(s, i, at, PEDESTAL, dk, 1, s->dk);
        add_bearing(s, i, at, PEDESTAL, dc, 1, s->dc);
    }
}

void system_film(const struct system *s, int bearing, const double complex *u, double complex film[2])
{
    int at = s->columns;
    for (int i = 0; i < bearing; i++)
        at += s->machine->bearing[i].pedestal.count > 0;
    system_orbit(s, s->bearing + (ptrdiff_t)s->columns * bearing, u, film);
    for (int plane = 0; plane < 2 && s->machine->bearing[bearing].pedestal.count; plane++) {
        double complex own = u[plane * s->plane + at];
        film[plane] = film_stands_alone(&s->machine->bearing[bearing]) ? own : film[plane] - own;
    }
}

/* On f the factor 1 + i eta side, on b 1 + i eta: with f = (x + iy)/2, b = (x - iy)/2 the force is
 *   x: eta K [i (1 + side)/2 x + (1 - side)/2 y],  y: eta K [i (1 + side)/2 y - (1 - side)/2 x]. */
void system_dynamic(const struct system *s, double complex lambda, int side, double complex *a)
{
    ptrdiff_t square = (ptrdiff_t)s->size * s->size;
    for (ptrdiff_t i = 0; i < square; i++)
        a[i] = lambda * lambda * s->mass[i] + lambda * s->c[i] + s->stiff[i];
    for (ptrdiff_t i = 0; i < square && s->hysteretic; i++)
        a[i] += CMPLX((1 - side) / 2.0 * s->turn[i], (1 + side) / 2.0 * s->h[i]);
}

int system_transfer(const struct system *from, const struct pair *pair, const struct system *to, struct pair *there)
{
    double length = 0;
    memset(there->u, 0, (size_t)to->size * sizeof *there->u);
    memset(there->left, 0, (size_t)to->size * sizeof *there->left);
    there->lambda = pair->lambda;
    for (int j = 0; j < from->columns; j++)
        for (int i = 0; i < to->columns; i++) {
            double part = product_dot(to->n, to->mass_basis + (ptrdiff_t)to->n * i, from->basis + (ptrdiff_t)from->n * j);
            there->u[i] += part * pair->u[j];
            there->u[to->plane + i] += part * pair->u[from->plane + j];
        }
    for (int plane = 0; plane < 2; plane++)
        for (int i = 0; i < from->plane - from->columns; i++)
            there->u[plane * to->plane + to->columns + i] = pair->u[plane * from->plane + from->columns + i];
    for (int i = 0; i < to->size; i++)
        length += creal(conj(there->u[i]) * there->u[i]);
    for (int i = 0; i < to->size; i++)
        there->u[i] /= sqrt(length);
    return !(length > 0.9);
}
