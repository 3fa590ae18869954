/* The modes among the shapes of a universal file, as real shapes. */
#ifndef ROTID_UFF_UFF_MODES_H
#define ROTID_UFF_UFF_MODES_H

#include "uff/uff.h"

/* What sets 55 of `rotid ema` hold beside the shapes. */
enum uff_extra { UFF_EXTRA_SHAPE_STD, UFF_EXTRA_POINT, UFF_EXTRA_POINT_STD, UFF_EXTRAS };

/* Whether a shape is one of a mode: not a frequency response. */
int uff_is_mode(const struct uff_shape *shape);

/* Modes by rising frequency, without those at 0 Hz and without the second of each conjugate pair: chosen[shape_count] gets them.
 * *rigid, *conjugates: how many are left out so. Returns their number. */
int uff_choose_modes(const struct uff_file *file, const struct uff_shape **chosen, int *rigid, int *conjugates);

/* Whether the numbers of the file are above zero and rise with the frequency; else modes are numbered from 1. */
int uff_modes_are_numbered(int count, const struct uff_shape *const *chosen);

/* Record 8 has six digits, which a good test knows better: `rotid ema` writes all of them in a line of text. [Hz] */
double uff_mode_frequency(const struct uff_shape *mode);

/* Component `component` at each node, [node_count], turned by the phase that makes its real part largest: the real vector nearest
 * to a complex one. Returns the share of the motion (sum of squares) that is out of phase. */
double uff_real_shape(const struct uff_shape *mode, int component, double *value);

/* Which set of `rotid ema` this is and of which mode, by its first line of text: UFF_EXTRAS where it is none. *number: 0 where
 * the text names none. */
enum uff_extra uff_extra_of(const struct uff_shape *set, int *number);

/* The standard deviation of the frequency [Hz], zero where it is not known, in the second line of a UFF_EXTRA_SHAPE_STD. 0, or 1
 * where the line has another form. */
int uff_extra_frequency_std(const struct uff_shape *set, double *hz);

#endif
