/* rotid-study: the command `study` over MPI. Rank 0 writes the file of results and hands out the runs; all compute. Everything
 * but the handing out is that of `rotid study`, so the files of both are the same.
 *
 * A rank has the next runs beside the one it computes, so that it need not wait for an answer. Rank 0 answers between its
 * own iterations. A rank that dies ends the whole job, as MPI has it; what arrived before stands in the file. */
#include <errno.h>
#include <mpi.h>
#include <time.h>

#include "cli/cli.h"

#define AHEAD           2   /* runs of a rank */
#define COMPUTING_RANKS 16  /* with more, rank 0 only writes and hands out */
#define GRACE           0.3 /* s for the others to answer once the job has been told to end */

enum { TAG_RUN = 1, TAG_LINE };

const struct command_entry command_table[] = {
    {"study", "many runs from one plan over MPI: mpirun -n N rotid-study PLAN -o RESULTS",
     "mpirun -n 4 rotid-study plan.inp -o results.jsonl\n"
     "rotid-study part1.jsonl part2.jsonl -o results.jsonl --merge",
     "inp|jsonl", command_study, PARALLEL | SEVERAL_FILES},
    {NULL, NULL, NULL, NULL, NULL, 0},
};

/* MPI_Probe and MPI_Recv keep a processor busy while they wait. */
static void rest(void)
{
    (void)nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
}

/* ---- rank 0 */

struct office {
    struct study_record *record;
    int size, *given;   /* ranks; [size] runs that each has got and not answered */
    int status, reason; /* what went wrong with the file, and its errno */
};

static int is_over(const struct office *office)
{
    return office->status || command_cancelled(NULL);
}

static void give(struct office *office, int rank)
{
    long run;
    while (office->given[rank] < AHEAD && !is_over(office) && (run = record_take(office->record)) >= 0) {
        MPI_Send(&run, 1, MPI_LONG, rank, TAG_RUN, MPI_COMM_WORLD);
        office->given[rank]++;
    }
}

static void keep(struct office *office, const char *line)
{
    if (office->status || !*line) /* empty: it was stopped */
        return;
    office->status = record_append(office->record, line);
    office->reason = errno;
}

/* Takes every line that has arrived. */
static void serve(struct office *office)
{
    MPI_Status from;
    int there, length;
    while (!MPI_Iprobe(MPI_ANY_SOURCE, TAG_LINE, MPI_COMM_WORLD, &there, &from) && there) {
        MPI_Get_count(&from, MPI_CHAR, &length);
        char *line = malloc((size_t)length + 1);
        if (!line) {
            MPI_Abort(MPI_COMM_WORLD, EXIT_INTERNAL);
            return;
        }
        MPI_Recv(line, length, MPI_CHAR, from.MPI_SOURCE, TAG_LINE, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        line[length] = 0;
        keep(office, line);
        free(line);
        office->given[from.MPI_SOURCE]--;
        give(office, from.MPI_SOURCE);
    }
    if (!office->status && record_sync(office->record, clock_seconds())) {
        office->status = ROTID_ERROR_IO;
        office->reason = errno;
    }
}

/* Between the iterations of rank 0's own run. */
static int serve_meanwhile(void *context)
{
    struct office *office = context;
    serve(office);
    return is_over(office);
}

static int is_waiting(const struct office *office)
{
    for (int rank = 1; rank < office->size; rank++)
        if (office->given[rank] > 0)
            return 1;
    return 0;
}

static void compute_own(struct office *office, struct jobs *jobs)
{
    const rotid_environment environment = {.size = sizeof environment, .cancelled = serve_meanwhile, .context = office};
    char *line;
    long run = record_take(office->record);
    if (run < 0)
        return;
    int status = study_run(jobs, run, &environment, &line);
    if (status == ROTID_ERROR_MEMORY)
        office->status = status;
    if (status == ROTID_OK)
        keep(office, line);
    free(line);
}

static int hand_out(void *context, struct command *command, const struct study *study, struct study_record *record)
{
    struct office *office = context;
    struct jobs jobs;
    int computes = office->size <= COMPUTING_RANKS;
    (void)command;
    office->record = record;
    office->given = calloc((size_t)office->size, sizeof *office->given);
    if (!office->given)
        return ROTID_ERROR_MEMORY;
    jobs_open(study, &jobs);
    for (int rank = 1; rank < office->size; rank++)
        give(office, rank);
    while (!is_over(office) && record->done < record->wanted) {
        long before = record->next;
        if (computes)
            compute_own(office, &jobs);
        serve(office);
        if (!computes || record->next == before)
            rest();
    }
    for (double end = clock_seconds() + GRACE; is_waiting(office) && clock_seconds() < end; rest())
        serve(office);
    jobs_close(&jobs);
    if (record_sync(record, INFINITY) && !office->status) {
        office->status = ROTID_ERROR_IO;
        office->reason = errno;
    }
    errno = office->reason;
    return office->status ? office->status : command_cancelled(NULL) ? ROTID_STOP_CANCELLED : ROTID_OK;
}

static int lead(struct command *command, const struct study *study, int size)
{
    const long end = -1;
    struct office office = {.size = size};
    int code = study_conduct(command, study, hand_out, &office);
    for (int rank = 1; rank < size; rank++)
        MPI_Send(&end, 1, MPI_LONG, rank, TAG_RUN, MPI_COMM_WORLD);
    free(office.given);
    return code;
}

/* ---- the other ranks */

static void follow(const struct study *study)
{
    const rotid_environment environment = {.size = sizeof environment, .cancelled = command_cancelled};
    struct jobs jobs;
    jobs_open(study, &jobs);
    for (;;) {
        char *line = NULL;
        long run;
        int there = 0;
        while (!MPI_Iprobe(0, TAG_RUN, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE) && !there)
            rest();
        MPI_Recv(&run, 1, MPI_LONG, 0, TAG_RUN, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (run < 0)
            break;
        if (study_run(&jobs, run, &environment, &line) == ROTID_ERROR_MEMORY)
            line = study_run_failed(study, run, rotid_status_text(ROTID_ERROR_MEMORY), 0);
        const char *text = line ? line : "";
        MPI_Send(text, (int)strlen(text), MPI_CHAR, 0, TAG_LINE, MPI_COMM_WORLD);
        free(line);
    }
    jobs_close(&jobs);
}

/* ---- all */

/* Whether every rank has read the same study: each reads the files itself. */
static int is_one_study(struct command *command, const struct study *study, int rank)
{
    const struct study_header header = header_of(&command->pool, study, command->head.rotid, command->head.commit, 1, 1);
    char *text = header_text(&header);
    uint64_t own = text ? digest_name(text) : 0, first = own;
    int all = 0;
    MPI_Bcast(&first, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    int same = text && own == first;
    free(text);
    if (!same)
        terminal_say("rotid-study: rank %d has read other files or is another program than rank 0, expected the same\n", rank);
    MPI_Allreduce(&same, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return all;
}

/* Arguments and files. Rank 0 first, so that what is wrong is said once. An exit code, -1 to go on. */
static int prepare(struct command *command, int argc, char **argv, int rank, int size, struct study *study)
{
    int code = -1, worst;
    for (int turn = 0; turn < 2; turn++) {
        if (turn == (rank > 0) && code < 0) {
            code = arguments_parse(command, argc, argv);
            if (code < 0)
                code = arguments_refuse(command, &command_table[0]);
            if (code < 0 && (command->threads || command->study.timeout > 0))
                code = arguments_wrong("%s is no option over MPI: a rank is a process, and only mpirun can end it",
                                       command->threads ? "--threads" : "--timeout");
            command->quiet |= rank > 0;
            command->threads = size;
            command_begin_head(command);
            build_set_threads(1);
            if (code < 0 && !build_make_room(1, 1))
                code = EXIT_INTERNAL;
            if (code < 0 && !command->study.merge && !command->study.summary) {
                int wrong = study_prepare(command, study);
                code = wrong ? wrong : -1;
            }
        }
        MPI_Allreduce(&code, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
        if (worst >= 0)
            return worst;
    }
    return code;
}

static int run(struct command *command, int argc, char **argv)
{
    struct study study;
    int rank, size;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    int code = prepare(command, argc, argv, rank, size, &study);
    if (code >= 0)
        return code;
    if (command->study.merge || command->study.summary)
        return rank ? EXIT_DONE : command_study(command);
    if (!is_one_study(command, &study, rank))
        return EXIT_USAGE;
    if (!rank)
        return lead(command, &study, size);
    follow(&study);
    return EXIT_DONE;
}

int main(int argc, char **argv)
{
    struct command command = {0};
    MPI_Init(&argc, &argv);
    command_set_signals();
    command_watch_signals();
    pool_open(&command.pool, NULL);
    message_open(&command.messages, &command.pool);
    char **words = POOL_ARRAY(&command.pool, char *, argc + 2); /* rotid-study PLAN is rotid study PLAN */
    if (!words || terminal_open())
        MPI_Abort(MPI_COMM_WORLD, EXIT_INTERNAL);
    words[0] = argv[0];
    words[1] = (char[]){"study"};
    memcpy(words + 2, argv + 1, (size_t)argc * sizeof *words);
    int code = run(&command, argc + 1, words);
    if (terminal_flush())
        code = terminal_end(EXIT_INTERNAL, "rotid-study: cannot write to standard output: %s\n", strerror(errno));
    pool_close(&command.pool);
    MPI_Finalize();
    return code;
}
