/* The public interface as text, one line a promise, and what a change of it means for hosts that were compiled before. */
#ifndef ROTID_TESTS_ABI_H
#define ROTID_TESTS_ABI_H

#include "header.h"

/* The lines "major 0", then "KEY = VALUE" in the order of the header: "constant ROTID_OK = 0", "struct rotid_deck = grows" (or
 * "sized", "fixed"), "member rotid_deck.path = 1: const char *" (its place, from 1), "callback rotid_residual = int (*)(...)",
 * "function rotid_lm = int (...)". Names of parameters are left out: no host depends on them. NULL: no memory. */
const char *abi_text(struct pool *pool, const struct header *header);

/* ABI_BROKEN: a host that was compiled with the old header does not run with a library of the new one. */
enum abi_change { ABI_SAME, ABI_ADDED, ABI_BROKEN };

/* What has become of the interface between two texts of abi_text of one major version. report: the changes, a line each, the
 * breaking ones first; "" for none. */
enum abi_change abi_compare(struct pool *pool, const char *before, const char *now, const char **report);

/* Nonzero: the library alone makes such structs, one at a time, so that members may be added at their ends. Hosts have all the
 * others in arrays, in structs of their own, or as arguments that the library reads whole. */
int abi_may_grow(const char *name);

/* Nonzero: its first member is size_t size, by which the library knows how much of it a host has, so that members may be added at
 * its end. */
int abi_says_its_size(const struct header_struct *structure);

/* Nonzero unless the header lets it be so: the struct stands by value in no other one and is handed out through a pointer to a
 * pointer, or to a callback. *why then says what is against it. */
int abi_cannot_grow(const struct header *header, const char *name, const char **why);

/* ROTID_VERSION_MAJOR, or -1. */
long abi_major(const struct header *header);

#endif
