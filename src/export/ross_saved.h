/* A rotor that ROSS has saved (Rotor.save, JSON) as one of rotid: bending in the plane x, at rest. */
#ifndef ROTID_EXPORT_ROSS_SAVED_H
#define ROTID_EXPORT_ROSS_SAVED_H

#include "base/message.h"
#include "base/pool.h"
#include "rotor/rotor.h"

struct ross_shaft_element {
    int n;                             /* node at its left end */
    double length, inner[2], outer[2]; /* m; left, right */
    struct material material;          /* nu = E/(2 G) - 1, as ROSS has it */
    double force;                      /* N, tension positive */
    const char *tag;
};

struct ross_disk {
    int n;
    double mass, diametral, polar;
    const char *tag;
};

struct ross_bearing {
    int n, link; /* link: node of the support that it stands on, -1: the ground */
    double kxx;  /* N/m, of the first speed */
    const char *tag;
};

struct ross_saved {
    const char *version; /* of ROSS */
    int nelement, ndisk, nbearing;
    size_t element_room, disk_room, bearing_room;
    struct ross_shaft_element *element; /* by node, then from the axis outwards */
    struct ross_disk *disk;             /* point masses among them */
    struct ross_bearing *bearing;       /* seals among them */
};

/* Reads the file. What is wrong is an error with its place in the JSON, what rotid does not compute (damping, gyroscopic and
 * torsional motion, cross coupling, other speeds) a warning. ROTID_OK, ROTID_ERROR_SYNTAX, _IO, _MEMORY. */
int ross_saved_read(struct pool *pool, const char *path, struct message_list *messages, struct ross_saved *saved);

/* The rotor of it: a group for neighbouring elements of the same material, sections of equal elements, elements around others as
 * layers, cones in ROSS_CONE_STEPS cylinders, bearings as springs, those on a support in series with it. Positions are those of
 * the nodes. Statuses as above: elements with a gap between them, disks and bearings at nodes that are not there are errors. */
int ross_saved_rotor(struct pool *pool, const char *path, const struct ross_saved *saved, struct message_list *messages,
                     struct rotor *rotor);

#define ROSS_CONE_STEPS 8

#endif
