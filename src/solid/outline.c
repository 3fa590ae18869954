#include "solid/solid.h"

#define MOST_HALVINGS 64 /* from one end of an interval: no two doubles are further apart */

ORDER_BY(by_place, struct stop, it->at, 0)

/* Sorts stops, and makes one of those nearer than `tolerance`: the finest of their sizes. Returns how many are left. */
static int stops_merge(int nstop, struct stop *stop, double tolerance)
{
    int count = 0;
    qsort(stop, (size_t)nstop, sizeof *stop, by_place);
    for (int i = 0; i < nstop; i++)
        if (count && stop[i].at - stop[count - 1].at <= tolerance) {
            struct stop *last = &stop[count - 1];
            if (stop[i].fine > 0 && (last->fine == 0 || stop[i].fine < last->fine))
                last->fine = stop[i].fine;
            if (stop[i].upto > 0 && (last->upto == 0 || stop[i].upto < last->upto))
                last->upto = stop[i].upto;
        } else {
            stop[count++] = stop[i];
        }
    return count;
}

/* Elements that double from a graded stop are as long, at a distance, as that and their first one: other stops go on with them,
 * unless they have shorter ones. */
static void stops_go_on(int nstop, struct stop *stop)
{
    for (int i = 0; i < nstop; i++) {
        double size = stop[i].fine > 0 ? stop[i].fine : (double)INFINITY;
        for (int j = 0; j < nstop; j++)
            if (stop[j].fine > 0)
                size = fmin(size, stop[j].fine + fabs(stop[i].at - stop[j].at));
        stop[i].fine = isfinite(size) ? size : 0;
    }
}

/* Lines between two stops, both excluded, into x, or counted only where x is NULL: from each graded end elements that double as
 * long as both sides leave room for them, and even ones between. */
static int between(const struct stop *a, const struct stop *b, int multiple, double *x)
{
    double from[MOST_HALVINGS], to[MOST_HALVINGS], left = a->at, right = b->at;
    double l = a->fine > 0 ? fmin(a->fine, a->upto) : a->upto, r = b->fine > 0 ? fmin(b->fine, a->upto) : a->upto;
    int nleft = 0, nright = 0, count = 0;
    while (right - left > 1.5 * fmin(l, r) && nleft < MOST_HALVINGS && nright < MOST_HALVINGS && fmin(l, r) < a->upto) {
        if (l <= r) {
            left = from[nleft++] = left + l;
            l = fmin(2 * l, a->upto);
        } else {
            right = to[nright++] = right - r;
            r = fmin(2 * r, a->upto);
        }
    }
    int even = (int)ceil((right - left) / (multiple * fmin(l, r)) - 0.3);
    even = multiple * (even < 1 ? 1 : even);
    for (int i = 0; i < nleft; i++, count++)
        if (x)
            x[count] = from[i];
    for (int i = 1; i < even; i++, count++)
        if (x)
            x[count] = left + (right - left) * i / even;
    for (int i = nright - 1; i >= 0; i--, count++)
        if (x)
            x[count] = to[i];
    return count;
}

/* Lines x [*count] through `nstop` >= 2 stops, increasing: from a graded stop the elements double until they reach the largest,
 * and there is a multiple of `multiple` of even ones.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
static int lines_graded(struct pool *pool, int nstop, const struct stop *stop, int multiple, int *count, double **x)
{
    int total = nstop;
    for (int i = 0; i + 1 < nstop; i++)
        total += between(&stop[i], &stop[i + 1], multiple, NULL);
    *x = POOL_ARRAY(pool, double, total);
    if (!*x)
        return ROTID_ERROR_MEMORY;
    *count = 0;
    for (int i = 0; i < nstop; i++) {
        (*x)[(*count)++] = stop[i].at;
        if (i + 1 < nstop)
            *count += between(&stop[i], &stop[i + 1], multiple, *x + *count);
    }
    return ROTID_OK;
}

#define SAME       1e-9 /* of the largest radius: radii that are one */
#define CORNER     0.05 /* of what both sides of it share, a radius or a wall: elements; leaves 0.03 % in frequencies */
#define NARROWEST  1e4  /* radius over that wall: beyond, rounding is larger than what it bends */
#define LARGEST    4    /* a quarter of the radius, or of the length of a disc */
#define COARSE     6    /* times CORNER in the coarse mesh: leaves 0.1 to 0.2 %, of which a tenth follows E and G */
#define THIN_WALL  4    /* radius over thickness from which on a wall is thin */
#define SLICES     50   /* or the longer of length and radius over this */
#define THINNEST   200 /* radius over the thickness of a flange, or length over the radius of a shaft, whose waves are resolved */
#define LONGEST    2   /* times the shorter one: elements that are longer lock in bending */
#define AT_LINE    0.01 /* of a slice: a sensor is taken to be at the line */
#define MOVES      0.35 /* of the slices beside it: how far a line moves to a sensor */
#define SMALL_BORE 0.02 /* of the largest element: half of a bore that counts no more */
#define INTERFACE  0.1  /* of the radius: elements at a plain interface, where a joint may be, and where a moment enters */

static double outline_inner(const struct rotor *rotor, int s)
{
    double inner = rotor->segment[s].inner;
    for (int i = 0; i < rotor->nring; i++)
        if (rotor->ring[i].segment == s)
            inner = fmin(inner, rotor->ring[i].inner);
    return inner / 2;
}

static double own_outer(const struct segment *segment)
{
    return fmin(segment->outer, segment->stiff_outer) / 2;
}

/* Radii of segment s without and with its rings [m]. */
static double outline_outer(const struct rotor *rotor, int s)
{
    double outer = 2 * own_outer(&rotor->segment[s]);
    for (int i = 0; i < rotor->nring; i++)
        if (rotor->ring[i].segment == s)
            outer = fmax(outer, rotor->ring[i].outer);
    return outer / 2;
}

int outline_group(const struct rotor *rotor, int s, double r)
{
    for (int i = 0; i < rotor->nring; i++)
        if (rotor->ring[i].segment == s && 2 * r > rotor->ring[i].inner && 2 * r < rotor->ring[i].outer)
            return rotor->ring[i].group;
    return 2 * r > rotor->segment[s].inner && r < own_outer(&rotor->segment[s]) ? rotor->segment[s].group : -1;
}

/* The annulus over which the holes of a group are smeared, as broad as a hole; where its second moment is that of the holes,
 * whose mean square radius is e^2 + d^2/8. */
static int hole_zone(const struct rotor *rotor, int group, double *from, double *to)
{
    const struct group *g = &rotor->group[group];
    double e = g->hole_pitch, d = g->hole_diameter, center = sqrt(fmax(e * e - d * d / 8, 0));
    *from = center - d / 2;
    *to = center + d / 2;
    return g->holes > 0;
}

double outline_share(const struct rotor *rotor, int group, double r)
{
    double from, to;
    const struct group *g = &rotor->group[group];
    if (!hole_zone(rotor, group, &from, &to) || r < from || r > to)
        return 1;
    return 1 - g->holes * g->hole_diameter * g->hole_diameter / (4 * (to * to - from * from));
}

static double largest_radius(const struct rotor *rotor)
{
    double radius = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        radius = fmax(radius, outline_outer(rotor, s));
    return radius;
}

double outline_slenderness(const struct rotor *rotor)
{
    return rotor_length(rotor) / (2 * largest_radius(rotor));
}

static int differ(const struct rotor *rotor, double a, double b)
{
    return fabs(a - b) > SAME * largest_radius(rotor);
}

int outline_touch(const struct rotor *rotor, int s)
{
    double inner = fmax(outline_inner(rotor, s - 1), outline_inner(rotor, s)),
           outer = fmin(outline_outer(rotor, s - 1), outline_outer(rotor, s));
    return inner < outer && differ(rotor, inner, outer);
}

int outline_corner(const struct rotor *rotor, int s, double r)
{
    double a = outline_outer(rotor, s), b = outline_outer(rotor, s + 1), c = outline_inner(rotor, s),
           d = outline_inner(rotor, s + 1);
    return (differ(rotor, a, b) && !differ(rotor, r, fmin(a, b))) || (differ(rotor, c, d) && !differ(rotor, r, fmax(c, d)));
}

static double corner_size(const struct rotor *rotor, const struct solid_rule *rule, int s, int refine)
{
    double outer = fmin(outline_outer(rotor, s), outline_outer(rotor, s + 1)),
           inner = fmax(outline_inner(rotor, s), outline_inner(rotor, s + 1)), thin = fmax(outer - inner, outer / NARROWEST);
    double size = rule->corner > 0 ? rule->corner : CORNER * thin;
    return refine ? size / refine : COARSE * size;
}

/* Whether the outline steps behind section s. */
static int is_step(const struct rotor *rotor, int s)
{
    return differ(rotor, outline_outer(rotor, s), outline_outer(rotor, s + 1)) ||
           differ(rotor, outline_inner(rotor, s), outline_inner(rotor, s + 1));
}

int outline_has_corners(const struct rotor *rotor)
{
    int s = 0;
    while (s + 1 < rotor->nsegment && !is_step(rotor, s))
        s++;
    return s + 1 < rotor->nsegment;
}

/* Without corners the coarse mesh has twice the size in both directions, else across alone. */
static double refined(const struct rotor *rotor, int refine, int along, double size)
{
    int halved = !along || !outline_has_corners(rotor);
    return refine ? size / sqrt(refine) : halved ? 2 * size : size;
}

/* A ring without corners turns over and twists: of its section, b by a >= b, elements of at most a sixteenth of a, or of b where
 * that is less, since the torsion of a strip turns round within b of its edges, but no more than 64 on a, and four on b. */
static double ring_size(const struct rotor *rotor)
{
    double wall = outline_outer(rotor, 0) - outline_inner(rotor, 0), length = rotor_length(rotor);
    double a = fmax(wall, length), b = fmin(wall, length);
    return outline_inner(rotor, 0) > 0 && !outline_has_corners(rotor) ? fmax(b / 4, fmin(a / 16, fmax(b, a / 64)))
                                                                      : (double)INFINITY;
}

/* Of a body of this radius and length: a quarter of the shorter of length and radius, and a fiftieth of the longer one, in both
 * directions; across the shorter one of a body that is much longer than wide, or wider than long, up to a quarter of the elements
 * along the other: thinner ones add nothing to the accuracy and rounding to K. */
static double largest_size(const struct rotor *rotor, const struct solid_rule *rule, int refine, int along, double radius,
                           double length)
{
    double extent[2] = {radius, length}, size[2];
    for (int i = 0; i < 2; i++)
        size[i] = fmax(fmin(extent[0], extent[1]) / LARGEST, fmin(extent[i] / SLICES, LONGEST * fmin(extent[0], extent[1])));
    double largest = fmin(fmax(size[along], fmin(extent[along], size[!along] / LARGEST)), ring_size(rotor));
    return refined(rotor, refine, along, rule->largest > 0 ? rule->largest : largest);
}

/* Along section s: as a shaft, which bends in shorter waves where it is slender than the body beside it; and of a thin wall half
 * of the root of radius times thickness, a fifth of the waves in which its ends bend, or, with corners, where no coarse mesh
 * tells what such elements leave, a quarter. */
static double largest_along(const struct rotor *rotor, const struct solid_rule *rule, int refine, int s)
{
    double length = rotor_length(rotor), outer = outline_outer(rotor, s), wall = outer - outline_inner(rotor, s);
    double size = largest_size(rotor, rule, refine, 1, fmax(outer, length / THINNEST), length);
    return THIN_WALL * wall < outer
               ? fmin(size, refined(rotor, refine, 1,
                                    fmax(sqrt(outer * wall) / (outline_has_corners(rotor) ? 4 : 2), length / THINNEST)))
               : size;
}

/* Without corners every element of the coarse mesh is cut into two, by which the errors of both have one ratio. */
static int multiple_of(const struct rotor *rotor, int refine)
{
    return refine && !outline_has_corners(rotor) ? 2 : 1;
}

/* Length of the shortest part of the body at this radius, that of the rotor where there is none. */
static double shortest_part(const struct rotor *rotor, double r)
{
    double shortest = rotor_length(rotor), length = 0;
    for (int s = 0; s <= rotor->nsegment; s++) {
        int is_in = s < rotor->nsegment && outline_inner(rotor, s) < r && r < outline_outer(rotor, s);
        if (!is_in && length > 0) /* it ended with the section before */
            shortest = fmin(shortest, length);
        length = is_in ? length + rotor->segment[s].length : 0;
    }
    return shortest;
}

/* Elements at the inside of a section, 0: they are as large as elsewhere. Motions go as 1/r beside a bore that is smaller. */
static double bore_size(const struct rotor *rotor, int refine, double inner, double largest)
{
    return inner > 0 && inner < largest ? fmax(refined(rotor, refine, 0, inner / 2), SMALL_BORE * largest) : 0;
}

int outline_has_small_bore(const struct rotor *rotor)
{
    const struct solid_rule rule = {0};
    double largest = largest_size(rotor, &rule, 1, 0, largest_radius(rotor), rotor_length(rotor));
    int s = 0;
    while (s < rotor->nsegment && !(bore_size(rotor, 1, outline_inner(rotor, s), largest) > 0))
        s++;
    return s < rotor->nsegment;
}

static int radial(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine, int *nr, double **r)
{
    double largest = largest_size(rotor, rule, refine, 0, largest_radius(rotor), rotor_length(rotor)), from, to;
    int most = 4 * rotor->nsegment + 2 * rotor->nring + 2 * rotor->ngroup * rotor->nsegment, n = 0;
    struct stop *stop = POOL_ARRAY(pool, struct stop, most);
    if (!stop)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < rotor->nsegment; s++) {
        double a = outline_outer(rotor, s), c = outline_inner(rotor, s);
        stop[n++] = (struct stop){a, 0, largest};
        stop[n++] = (struct stop){c, bore_size(rotor, refine, c, largest), largest};
        stop[n++] = (struct stop){rotor->segment[s].inner / 2, 0, largest};
        stop[n++] = (struct stop){own_outer(&rotor->segment[s]), 0, largest};
        for (int side = 0; side < 2; side++)
            for (int t = s > 0 ? s - 1 : 0; t <= s && t + 1 < rotor->nsegment; t++)
                if (outline_corner(rotor, t, side ? c : a)) {
                    double size = corner_size(rotor, rule, t, refine);
                    struct stop *here = &stop[n - 4 + side];
                    here->fine = here->fine > 0 ? fmin(here->fine, size) : size;
                }
        for (int g = 0; g < rotor->ngroup; g++)
            if ((g == rotor->segment[s].group || rotor->group[g].layer_of == rotor->segment[s].group) &&
                hole_zone(rotor, g, &from, &to)) {
                stop[n++] = (struct stop){from, 0, largest};
                stop[n++] = (struct stop){to, 0, largest};
            }
    }
    for (int i = 0; i < rotor->nring; i++) {
        stop[n++] = (struct stop){rotor->ring[i].inner / 2, 0, largest};
        stop[n++] = (struct stop){rotor->ring[i].outer / 2, 0, largest};
    }
    n = stops_merge(n, stop, SAME * largest);
    for (int i = 0; i + 1 < n; i++) { /* a thin flange bends as a plate */
        double length = fmax(shortest_part(rotor, (stop[i].at + stop[i + 1].at) / 2), largest_radius(rotor) / THINNEST);
        stop[i].upto = fmin(stop[i].upto, largest_size(rotor, rule, refine, 0, largest_radius(rotor), length));
    }
    stops_go_on(n, stop);
    return lines_graded(pool, n, stop, multiple_of(rotor, refine), nr, r);
}

/* Elements where a disk or a spring brings a moment into the section at z: its stresses are not those of bending within about a
 * radius. What they leave the coarse mesh tells, which has none there. */
static double moment_size(const struct rotor *rotor, int refine, double z)
{
    return refine ? INTERFACE * outline_outer(rotor, rotor_segment_at(rotor, z)) : 0;
}

static int axial_stops(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine, int *nstop,
                       struct stop **stops)
{
    double largest = largest_size(rotor, rule, refine, 1, largest_radius(rotor), rotor_length(rotor)), end = 0,
           smallest = largest;
    int n = 0, most = rotor->nsegment + 1 + rotor->nspring + 3 * rotor->ndisk + 2 * rotor->ntierod + 3 * rotor->nbars;
    struct stop *stop = POOL_ARRAY(pool, struct stop, most);
    if (!stop)
        return ROTID_ERROR_MEMORY;
    stop[n++] = (struct stop){0, 0, largest};
    for (int s = 0; s < rotor->nsegment; s++) {
        double size = 0;
        end += rotor->segment[s].length;
        if (s + 1 < rotor->nsegment && is_step(rotor, s))
            size = corner_size(rotor, rule, s, refine);
        else if (s + 1 < rotor->nsegment && rotor->segment[s].group != rotor->segment[s + 1].group)
            size = INTERFACE * outline_outer(rotor, s);
        stop[n++] = (struct stop){end, size, largest};
        smallest = size > 0 ? fmin(smallest, size) : smallest;
    }
    for (int i = 0; i < rotor->nspring; i++) {
        const struct spring *spring = &rotor->spring[i];
        double size = spring->rotational > 0 ? moment_size(rotor, refine, spring->position) : 0;
        stop[n++] = (struct stop){spring->position, size, largest};
    }
    for (int i = 0; i < rotor->ndisk; i++) {
        double from, to, at = rotor->disk[i].position;
        stop[n++] = (struct stop){at, moment_size(rotor, refine, at), largest}; /* a cause may add inertia to any */
        if (rotor->disk[i].hub_length > 0) {
            rotor_hub_span(rotor, i, &from, &to);
            stop[n++] = (struct stop){from, 0, largest};
            stop[n++] = (struct stop){to, 0, largest};
        }
    }
    for (int i = 0; i < rotor->ntierod; i++) {
        stop[n++] = (struct stop){rotor->tierod[i].from, 0, largest};
        stop[n++] = (struct stop){rotor->tierod[i].to, 0, largest};
    }
    for (int i = 0; i < rotor->nbars; i++) {
        const struct bars *bars = &rotor->bars[i];
        for (int side = -1; side <= 1; side++)
            stop[n++] = (struct stop){fmin(fmax(bars->center + side * bars->length / 2, 0), end), 0, largest};
    }
    *stops = stop;
    *nstop = stops_merge(n, stop, fmin(1e-6 * end, 0.01 * smallest));
    end = rotor->segment[0].length;
    for (int i = 0, s = 0; i + 1 < *nstop; i++) {
        while (s + 1 < rotor->nsegment && (stop[i].at + stop[i + 1].at) / 2 > end)
            end += rotor->segment[++s].length;
        stop[i].upto = fmin(stop[i].upto, largest_along(rotor, rule, refine, s));
    }
    stops_go_on(*nstop, stop);
    return ROTID_OK;
}

/* A line at a sensor where a line that nothing else needs is near, so that a slice has one sensor between its ends at most: it
 * takes a node of the slice, of which there is one. */
static int lines_at_sensors(struct pool *pool, const struct rotor *rotor, const int *fixed_before, int *nz, double **z)
{
    int n = *nz, inside = -1, room = n + rotor->nsensor;
    double *x = POOL_ARRAY(pool, double, room);
    int *fixed = POOL_ARRAY(pool, int, room);
    if (!x || !fixed)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++) {
        x[i] = (*z)[i];
        fixed[i] = fixed_before[i];
    }
    for (int s = 0; s < rotor->nsensor; s++) {
        double at = rotor->sensor[s].position;
        int i = 0, near;
        while (i < n - 2 && x[i + 1] <= at)
            i++;
        near = at - x[i] < x[i + 1] - at ? i : i + 1;
        double distance = fabs(at - x[near]);
        if (distance <= AT_LINE * (x[i + 1] - x[i]) && fixed[near])
            continue;
        if (!fixed[near] && !(near == i && inside == i) &&
            distance < MOVES * fmin(x[near] - x[near - 1], x[near + 1] - x[near])) {
            x[near] = at;
            fixed[near] = 1;
        } else if (inside < i) {
            inside = i;
        } else {
            for (int j = n++; j > i + 1; j--) {
                x[j] = x[j - 1];
                fixed[j] = fixed[j - 1];
            }
            x[i + 1] = at;
            fixed[i + 1] = 1;
        }
    }
    *nz = n;
    *z = x;
    return ROTID_OK;
}

/* lines where something of the rotor is, which no sensor may move */
static int *fixed_lines(struct pool *pool, int nstop, const struct stop *stop, int nz, const double *z)
{
    int *fixed = POOL_ARRAY(pool, int, nz);
    for (int i = 0, s = 0; i < nz && fixed; i++)
        if (s < nstop && z[i] == stop[s].at)
            fixed[i] = ++s > 0;
    return fixed;
}

int outline_lines(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine, int *nr, double **r,
                  int *nz, double **z, int **segment)
{
    struct stop *stop;
    int nstop, status = radial(pool, rotor, rule, refine, nr, r);
    if (!status)
        status = axial_stops(pool, rotor, rule, refine, &nstop, &stop);
    if (!status)
        status = lines_graded(pool, nstop, stop, multiple_of(rotor, refine), nz, z);
    if (status)
        return status;
    int *fixed = fixed_lines(pool, nstop, stop, *nz, *z);
    status = fixed ? lines_at_sensors(pool, rotor, fixed, nz, z) : ROTID_ERROR_MEMORY;
    *segment = POOL_ARRAY(pool, int, *nz);
    if (status || !*segment)
        return ROTID_ERROR_MEMORY;
    double end = rotor->segment[0].length;
    for (int i = 0, s = 0; i + 1 < *nz; i++) {
        while (s + 1 < rotor->nsegment && ((*z)[i] + (*z)[i + 1]) / 2 > end)
            end += rotor->segment[++s].length;
        (*segment)[i] = s;
    }
    return ROTID_OK;
}
