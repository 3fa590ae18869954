/* Files that are whole or not there: written beside their final name, then renamed. */
#ifndef ROTID_REPORT_OUTPUT_H
#define ROTID_REPORT_OUTPUT_H

/* Writes text to path, "-" being standard output. ROTID_OK or ROTID_ERROR_IO (errno tells why), ROTID_ERROR_MEMORY. */
int output_write(const char *path, const char *text);

#endif
