/* Which files in the folder of figures are rotid's: a list beside them, .files, with the digest of each as it was written. What a
 * later page does not need goes where it is on the list and has not changed since; what anybody else put there or changed stays.
 */
#ifndef ROTID_PAGE_FOLDER_FILES_H
#define ROTID_PAGE_FOLDER_FILES_H

#include "page/folder.h"

/* Writes the list of what is in folder->figures. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_IO with a message. */
int files_list(const struct folder *folder, struct message_list *messages);

/* Prepares `figures`, the folder of figures of an earlier page, for what is in folder->figures: removes what rotid wrote and the
 * new page does not have, and keeps under another name, with a warning, what the new page would write over and is not rotid's:
 * files that are not on the list, scripts that were changed. A folder without a list stays as it is. ROTID_OK,
 * ROTID_ERROR_MEMORY. */
int files_prepare(const struct folder *folder, int figures, struct message_list *messages);

#endif
