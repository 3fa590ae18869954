/* What a picture of a figure may be, judged apart from the program: well-formed, and nothing in it runs, loads or leads
 * elsewhere.
 */
#ifndef ROTID_TESTS_PICTURE_CHECK_H
#define ROTID_TESTS_PICTURE_CHECK_H

/* Problems of an SVG: elements that draw nothing, are not closed or in wrong order, attributes that run or refer to anything but
 * a part of the same picture. Each is printed; their number. */
int picture_problems(const char *svg);

/* The text behind "data:image/svg+xml;base64," up to the quote that ends it (to be freed), NULL where it is none. */
char *picture_of_uri(const char *uri);

#endif
