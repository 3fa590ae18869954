#include "study/study.h"

#include <stdio.h>
#include <string.h>

/* FNV-1a (Fowler, Noll, Vo) */
#define BASIS 0xcbf29ce484222325u
#define PRIME 0x100000001b3u

void digest_bytes(struct digest *digest, size_t count, const void *bytes)
{
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < count; i++)
        digest->state = (digest->state ^ byte[i]) * PRIME;
}

void digest_open(struct digest *digest)
{
    digest->state = BASIS;
}

void digest_integer(struct digest *digest, long long value)
{
    unsigned char byte[8]; /* by value: the same on every machine */
    for (int i = 0; i < 8; i++)
        byte[i] = (unsigned char)((unsigned long long)value >> (8 * i));
    digest_bytes(digest, sizeof byte, byte);
}

static void digest_doubles(struct digest *digest, size_t count, const double *value)
{
    for (size_t i = 0; i < count; i++) {
        long long bits = -1; /* one NaN is like another */
        if (value[i] == value[i])
            memcpy(&bits, &value[i], sizeof bits);
        digest_integer(digest, bits);
    }
}

void digest_text(struct digest *digest, const char *text)
{
    digest_integer(digest, text ? (long long)strlen(text) : -1);
    digest_bytes(digest, text ? strlen(text) : 0, text);
}

void digest_cards(struct digest *digest, const struct deck_text *text)
{
    digest_integer(digest, text->ncard);
    for (int c = 0; c < text->ncard; c++) {
        const struct card *card = &text->card[c];
        digest_text(digest, card->name);
        digest_integer(digest, card->noption);
        for (int i = 0; i < card->noption; i++) {
            digest_text(digest, card->option[i].name);
            digest_text(digest, card->option[i].value);
        }
        digest_integer(digest, card->nline);
        for (int i = 0; i < card->nline; i++) {
            digest_integer(digest, card->line[i].count);
            for (int f = 0; f < card->line[i].count; f++)
                digest_text(digest, card->line[i].field[f].text);
        }
    }
}

void digest_measured(struct digest *digest, const struct job *job)
{
    size_t nmode = (size_t)job->measurement.nmode, components = nmode * (size_t)job->rotor.nsensor;
    digest_integer(digest, job->measurement.nmode);
    digest_integer(digest, job->rotor.nsensor);
    for (int k = 0; k < job->measurement.nmode; k++)
        digest_integer(digest, job->measurement.number[k]);
    for (int s = 0; s < job->rotor.nsensor; s++) {
        digest_integer(digest, job->rotor.sensor[s].id);
        digest_doubles(digest, 1, &job->rotor.sensor[s].position);
    }
    digest_doubles(digest, nmode, job->measurement.frequency_hz);
    digest_doubles(digest, nmode, job->measurement.frequency_std);
    digest_doubles(digest, job->measurement.shape ? components : 0, job->measurement.shape);
    digest_doubles(digest, job->measurement.shape ? components : 0, job->measurement.shape_std);
    digest_doubles(digest, job->measurement.point_frequency_hz ? components : 0, job->measurement.point_frequency_hz);
    digest_doubles(digest, job->measurement.point_frequency_hz ? components : 0, job->measurement.point_frequency_std);
    digest_integer(digest, job->measurement.hammer);
}

void digest_letters(const struct digest *digest, char letters[DIGEST_LETTERS + 1])
{
    (void)snprintf(letters, DIGEST_LETTERS + 1, "%016llx", (unsigned long long)digest->state);
}

uint64_t digest_name(const char *name)
{
    struct digest digest;
    digest_open(&digest);
    digest_text(&digest, name);
    return digest.state;
}
