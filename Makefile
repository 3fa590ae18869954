# rotid. The usual targets:
#   make            builds the program build/rotid and the library: build/librotid.a, build/librotid.so; make MPI=1:
#                   build/rotid-study as well
#   make demo       identifies the paper's rotor from its measured frequencies, diagnoses a beam, and makes a page of that
#   make figures    the paper's figures and Table 1 for its rotor, beside the paper's numbers, as pages
#   make test       builds and runs the tests; ends with one line "N passed, N failed"; make test-long: the rest, effects hidden by dozens
#   make power      hides effects in a thousand random rotors and counts what the diagnosis makes of them
#   make power-solid, coverage-solid   the same of solids of revolution by other elements
#   make bench      speed beside SciPy, MINPACK, NLopt, sdypy-EMA, ROSS and CalculiX in one run; make bench-quick: its correctness
#                   part only; make bench-check: instructions of fixed runs, by valgrind, beside those recorded; make bench-growth:
#                   how they grow with elements, sensors, modes, parameters, states, replicates
#   make check-asan, make check-valgrind    the tests under the address and undefined-behaviour sanitizers, under valgrind
#   make check-tsan   calls from several threads under the thread sanitizer
#   make check-peers   against SciPy, pyuff, sdypy-EMA and jsonschema, installed into build/venv
#   make check-embedding   the programs of docs/embedding.md with gcc, clang, flang, make, CMake, Python, as far as they are there
#   make check-solid3d   solids by CalculiX (calculix-ccx) beside rotid modes with MODEL=SOLID, and one in rotation beside rotid speeds
#   make check-blas   the library with reference LAPACK and with BLIS
#   make check-mpi  1,000 identifications: throughput, kill -9 and restart, two MPI ranks beside one
#   make chain      the virtual hammer test a hundred times: do the moduli lie in their intervals
#   make fuzz       the readers of decks, tables, universal files, measured records, plans and results, and suggest, on random input, FUZZ_SECONDS (600) each
#   make check-pages   pages in Chromium: figures, buttons, phone, print, hostile texts; make test does so where Chromium is there
#   make sweep      report, in a browser, on 2,000 hostile texts (SWEEP_PAYLOADS) in results of every kind
#   make coverage   share of the lines of src that the tests run
#   make frozen     outputs of every command on every deck beside those of another commit: REF=commit
#   make mutate     makes the mistakes of tests/mutations one by one in a copy: does the named test fail? ROWS="covariance 118": of these
#   make lint, make format                  clang-tidy, checks of the manual pages; clang-format
#   make abi        the snapshot of the public interface anew, include/rotid.abi (CONTRIBUTING.md)
#   make fortran    the types of results in include/rotid.f90 anew, from include/rotid.h
#   make tables     completions, the option lists of docs/rotid.1 and the card tables of docs/deck.md anew, from their rows in src
#   make install, make uninstall            with PREFIX (/usr/local), DESTDIR, and BINDIR, LIBDIR, PKGCONFIGDIR, CMAKEDIR, INCLUDEDIR,
#                   DATADIR, MANDIR, DOCDIR, BASHDIR, ZSHDIR, FISHDIR for what is to go elsewhere
#   make clean
# Options: CC, CFLAGS, BUILD (build), WITH_NLOPT=0 for a build without the NLopt baseline, WERROR=1, V=1: whole commands.
#   D3=FILE         d3.min.js to draw figures with, in place of the modules of node-d3; D3= builds a program whose pages have none
#   BLAS=openblas   or reference (libblas as it is installed), blis, or names of pkg-config; BLAS_CFLAGS and BLAS_LIBS for what
#                   pkg-config does not know. Each in a BUILD of its own.

BUILD      ?= build
CC         ?= cc
CXX        ?= c++
CFLAGS     ?= -O2 -g
OBJCOPY    ?= objcopy
NM         ?= nm
WITH_NLOPT ?= 1
PYTHON     ?= python3
CLANG_TIDY ?= clang-tidy
CLANG_FORMAT ?= clang-format
FUZZ_CC    ?= clang-14
FUZZ_SECONDS ?= 600

PREFIX       ?= /usr/local
BINDIR       ?= $(PREFIX)/bin
LIBDIR       ?= $(PREFIX)/lib
PKGCONFIGDIR ?= $(LIBDIR)/pkgconfig
CMAKEDIR     ?= $(LIBDIR)/cmake/rotid
INCLUDEDIR   ?= $(PREFIX)/include
DATADIR      ?= $(PREFIX)/share
MANDIR       ?= $(DATADIR)/man
DOCDIR       ?= $(DATADIR)/doc/rotid
BASHDIR      ?= $(DATADIR)/bash-completion/completions
ZSHDIR       ?= $(DATADIR)/zsh/site-functions
FISHDIR      ?= $(DATADIR)/fish/vendor_completions.d

# the version stands in the header alone
VERSION := $(shell awk '$$2 == "ROTID_VERSION" { gsub("\"", "", $$3); print $$3 }' include/rotid.h)
SONAME  := librotid.so.$(shell awk '$$2 == "ROTID_VERSION_MAJOR" { print $$3 }' include/rotid.h)
SHARED  := librotid.so.$(VERSION)

# The BLAS, with its C interface: a package of pkg-config, or the usual name of the library where there is none.
BLAS ?= openblas
package = $(shell pkg-config --exists $(1) 2>/dev/null && echo $(1))
BLAS_PACKAGES_reference = $(firstword $(call package,blas-netlib) $(call package,cblas) $(call package,blas))
BLAS_PACKAGES_blis      = $(call package,blis)
BLAS_PACKAGES := $(if $(filter reference blis,$(BLAS)),$(BLAS_PACKAGES_$(BLAS)),$(BLAS))
ifeq ($(origin BLAS_LIBS),undefined)
BLAS_LIBS := $(if $(BLAS_PACKAGES),$(shell pkg-config --libs $(BLAS_PACKAGES)),$(if $(filter blis,$(BLAS)),-lblis,-lblas))
BLAS_CFLAGS ?= $(if $(BLAS_PACKAGES),$(shell pkg-config --cflags $(BLAS_PACKAGES)))
endif

# what the library calls, and what the program calls beside it
PACKAGES := lapacke $(if $(filter 1,$(WITH_NLOPT)),nlopt)
PROGRAM_PACKAGES := kissfft-float libcjson

COMMIT := $(shell git rev-parse --short=12 HEAD 2>/dev/null || echo unknown)
WARNINGS := -Wall -Wextra -Wpedantic -Wconversion -Wshadow $(if $(filter 1,$(WERROR)),-Werror)
ALL_CFLAGS = -std=c17 -D_POSIX_C_SOURCE=200809L -D_FILE_OFFSET_BITS=64 $(WARNINGS) -fvisibility=hidden -fPIC -Iinclude -Isrc \
             -DWITH_NLOPT=$(WITH_NLOPT) $(patsubst -I%,-isystem%,$(BLAS_CFLAGS)) $(shell pkg-config --cflags $(PACKAGES) $(PROGRAM_PACKAGES)) $(CFLAGS)
LIBRARY_LIBS := $(shell pkg-config --libs lapacke) $(BLAS_LIBS) $(if $(filter 1,$(WITH_NLOPT)),$(shell pkg-config --libs nlopt)) -lm -pthread
# The program takes what it calls of LAPACKE out of the archive, where there is one: of the shared library the loader looks up all
# 2,500 names, in each start. OpenBLAS holds the LAPACK below it.
LAPACKE_ARCHIVE := $(if $(findstring openblas,$(BLAS)),$(filter /%,$(shell $(CC) -print-file-name=liblapacke.a)))
PROGRAM_LIBS := $(shell pkg-config --libs $(PROGRAM_PACKAGES)) $(if $(LAPACKE_ARCHIVE),$(patsubst -llapacke,$(LAPACKE_ARCHIVE),$(LIBRARY_LIBS)),$(LIBRARY_LIBS))

# the rooms that public routines reach, and those of the program alone
LIBRARY_ROOMS := base record linalg rotor beam solid model modal fit run running diagnose/causes diagnose suggest file uff deck api
LIBRARY_SOURCES := $(foreach room,$(LIBRARY_ROOMS),$(wildcard src/$(room)/*.c))
PROGRAM_SOURCES := $(foreach room,signal ema import result report export study page,$(wildcard src/$(room)/*.c))
CLI_SOURCES := $(wildcard src/cli/*.c)
OBJECTS_OF = $(patsubst %.c,$(BUILD)/%.o,$(1))
LIBRARY_OBJECTS := $(call OBJECTS_OF,$(LIBRARY_SOURCES))
# Style and script of a page, and the parts of D3 that it draws with: of Debian's node-d3, or one file that D3 names. D3= is none.
D3_PARTS := array collection color format interpolate path shape time time-format scale
D3 ?= $(foreach part,$(D3_PARTS),$(wildcard /usr/share/nodejs/d3-$(part)/dist/d3-$(part).min.js))
EMBEDDED := $(BUILD)/src/page/embedded.o
# what the program and the tests link: with the names that librotid keeps to itself
OBJECTS := $(BUILD)/rotid-objects.a
PROGRAM_OBJECTS = $(call OBJECTS_OF,$(PROGRAM_SOURCES)) $(EMBEDDED)

TESTS := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c))
SUPPORT_OBJECTS := $(call OBJECTS_OF,$(filter-out $(wildcard tests/test_*.c),$(wildcard tests/*.c))) $(call OBJECTS_OF,$(wildcard tools/oracle/*.c)) \
                   $(call OBJECTS_OF,$(filter-out %/hide_main.c %/power.c %/hammer_main.c,$(wildcard tools/hide/*.c tools/power/*.c tools/hammer/*.c)))
# archives, so that a test program links what it calls and no more
SUPPORT := $(BUILD)/tests/support.a
ROOMS := $(BUILD)/program-objects.a
TEST_PROGRAMS := $(addprefix $(BUILD)/tests/,$(TESTS))

# One short line a file; V=1 shows the commands.
QUIET := $(if $(filter 1,$(V)),,@)
tell = $(if $(filter 1,$(V)),,@echo '$(1) $(patsubst $(BUILD)/%,%,$(2))')

.PHONY: all abi schema demo figures test chain power bench bench-quick check-asan check-valgrind check-peers check-embedding check-mpi fuzz fuzzers \
        coverage lint format install uninstall clean
.DELETE_ON_ERROR:

all: $(BUILD)/rotid $(BUILD)/librotid.a $(BUILD)/librotid.so
ifeq ($(MPI),1)
all: $(BUILD)/rotid-study
endif

$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(call tell,CC,$<)
	$(QUIET)$(CC) $(ALL_CFLAGS) $(EXTRA_$(basename $(notdir $<))) -MMD -MP -c $< -o $@

$(BUILD)/d3: FORCE
	@mkdir -p $(@D)
	@echo '$(D3)' | cmp -s - $@ || echo '$(D3)' > $@
$(BUILD)/embedded.c: tools/embed src/page/page.css src/page/page.js $(D3) $(BUILD)/d3
	@sh tools/embed src/page/page.css src/page/page.js $(D3) > $@
$(EMBEDDED): $(BUILD)/embedded.c
	@mkdir -p $(@D)
	$(call tell,CC,$<)
	$(QUIET)$(CC) $(ALL_CFLAGS) -c $< -o $@

# The commit stands in every result, so the file that holds it follows it.
EXTRA_blas = -DROTID_BLAS='"$(BLAS)"' -DROTID_OPENBLAS=$(if $(findstring openblas,$(BLAS)),1,0)
EXTRA_build_info = -DROTID_COMMIT='"$(COMMIT)"'
$(BUILD)/src/cli/build_info.o: $(BUILD)/commit
$(BUILD)/commit: FORCE
	@mkdir -p $(@D)
	@echo '$(COMMIT)' | cmp -s - $@ || echo '$(COMMIT)' > $@
FORCE:

$(OBJECTS): $(LIBRARY_OBJECTS)
$(SUPPORT): $(SUPPORT_OBJECTS)
$(ROOMS): $(PROGRAM_OBJECTS)
# q: members of one name stay beside each other
$(OBJECTS) $(SUPPORT) $(ROOMS):
	@rm -f $@
	$(call tell,AR,$@)
	$(QUIET)$(AR) qcs $@ $^

# Static: every object for itself, so that a host links those alone that it calls. Their hidden names begin with rotid_private_
# there, so that a host may have a pool_open too.
$(BUILD)/private.names: $(LIBRARY_OBJECTS)
	@$(NM) -g --defined-only $^ | awk 'NF == 3 && $$3 !~ /^rotid_/ { print $$3, "rotid_private_" $$3 }' | LC_ALL=C sort -u > $@
# With -flto what the compiler has left to the linker is made first. Of the flags only those that decide what kind of object it is: a
# sanitizer's would link its library.
KIND_FLAGS = $(filter -m% -flto% -fuse-ld=%,$(CFLAGS) $(LDFLAGS)) -flinker-output=nolto-rel
MEMBERS := $(LIBRARY_OBJECTS:$(BUILD)/src/%.o=$(BUILD)/members/%.o)
$(MEMBERS): $(BUILD)/members/%.o: $(BUILD)/src/%.o $(BUILD)/private.names
	@mkdir -p $(@D)
	@$(if $(filter -flto%,$(CFLAGS)),$(CC) -r -nostdlib $(KIND_FLAGS) $< -o $@.made && )$(OBJCOPY) \
	    --redefine-syms=$(BUILD)/private.names $(if $(filter -flto%,$(CFLAGS)),$@.made,$<) $@
# in one folder a member would take the place of another of its name
$(BUILD)/librotid.a: $(MEMBERS)
	@rm -f $@
	$(call tell,AR,$@)
	$(QUIET)$(AR) qcs $@ $^

# Shared, and what a static host has to link beside it, for rotid.pc: without folders of this machine where the linker finds the
# libraries by itself. A sanitizer's names come with the program.
NO_UNDEFINED = $(if $(findstring -fsanitize,$(CFLAGS) $(LDFLAGS)),,-Wl,-z,defs)
$(BUILD)/$(SHARED): $(LIBRARY_OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) -shared -Wl,-soname,$(SONAME) $(NO_UNDEFINED) $(CFLAGS) $(LDFLAGS) $^ $(LIBRARY_LIBS) -o $@
	@echo 'int main(void) { return 0; }' | $(CC) -x c - -x none $(filter-out -L%,$(LIBRARY_LIBS)) -o $(BUILD)/finds 2>/dev/null && \
	    rm $(BUILD)/finds && echo '$(filter-out -L%,$(LIBRARY_LIBS))' > $(BUILD)/librotid.libs || echo '$(LIBRARY_LIBS)' > $(BUILD)/librotid.libs
$(BUILD)/librotid.so: $(BUILD)/$(SHARED)
	@ln -sf $(SHARED) $(BUILD)/$(SONAME)
	@ln -sf $(SONAME) $@

$(BUILD)/rotid: $(call OBJECTS_OF,$(CLI_SOURCES)) $(PROGRAM_OBJECTS) $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ $(PROGRAM_LIBS) -o $@

# The same studies over MPI; nothing else depends on it.
MPICC ?= mpicc
STUDY_RUNS ?= 1000
$(BUILD)/src/mpi/%.o: override CC = $(MPICC)
$(BUILD)/rotid-study: $(call OBJECTS_OF,src/mpi/rotid_study.c $(filter-out %/main.c %/command_table.c,$(CLI_SOURCES))) $(PROGRAM_OBJECTS) $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(MPICC) $(CFLAGS) $(LDFLAGS) $^ $(PROGRAM_LIBS) -o $@

check-mpi:
	@$(MAKE) --no-print-directory MPI=1 all
	@sh tests/study/mpi $(BUILD) $(STUDY_RUNS)

# Effects hidden in simulated measurements: shares no code with the library.
$(BUILD)/hide: $(call OBJECTS_OF,$(wildcard tools/hide/*.c tools/oracle/*.c))
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ -lm -o $@
$(BUILD)/tools/hide/%.o $(BUILD)/tools/power/%.o $(BUILD)/tools/hammer/%.o: ALL_CFLAGS += -Itools -Itests

# A hammer test as it would be recorded: time records in a universal file.
$(BUILD)/hammer: $(call OBJECTS_OF,$(wildcard tools/hammer/*.c tools/oracle/*.c) $(filter-out %/hide_main.c,$(wildcard tools/hide/*.c)))
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ -lm -o $@

# Fresh rotors with hidden effects by the thousand; POWER holds options, such as "--cases 200 --log FILE".
$(BUILD)/power: $(BUILD)/tools/power/power.o $(SUPPORT) $(ROOMS) $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ -lcmocka $(PROGRAM_LIBS) -o $@
power: $(BUILD)/power
	@OPENBLAS_NUM_THREADS=1 $(BUILD)/power $(POWER)

# Some link hosts of their own, in the way the library was built.
$(BUILD)/tests/%.o: ALL_CFLAGS += -Itests -Itools -DROTID_SOURCE_DIR='"$(CURDIR)"' -DROTID_PROGRAM='"$(abspath $(BUILD))/rotid"' \
    -DROTID_BUILD='"$(abspath $(BUILD))"' -DROTID_CC='"$(CC)"' -DROTID_CXX='"$(CXX)"' -DROTID_FLAGS='"$(CFLAGS) $(LDFLAGS)"'
# compiled once, run once: what they call is optimised
$(BUILD)/tests/test_%.o: ALL_CFLAGS += -O0
# these compute much themselves
EXTRA_test_evidence = -O2
EXTRA_test_modal_fit = -O2
# gold, where it is there, links these hundreds in half the time of ld
TEST_LINKER := $(if $(shell command -v ld.gold 2>/dev/null),-fuse-ld=gold)
$(TEST_PROGRAMS): %: %.o $(SUPPORT) $(ROOMS) $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(TEST_LINKER) $(CFLAGS) $(LDFLAGS) $^ $(ROOMS) $(OBJECTS) -lcmocka $(PROGRAM_LIBS) -o $@

# These go from records of a hammer test on, which that program makes.
$(BUILD)/tests/test_page $(BUILD)/tests/test_tutorial: | $(BUILD)/hammer

chain: $(BUILD)/tests/test_chain
	@ROTID_CHAIN_RUNS=100 OPENBLAS_NUM_THREADS=1 $<

# In a browser, where there is one: once more behind tools/setup --ci, which installs Chromium.
.PHONY: check-pages
check-pages: all $(BUILD)/tests/test_page_browser $(BUILD)/tests/test_report_sweep
	@sh tools/run-tests $(BUILD)/tests/test_page_browser $(BUILD)/tests/test_report_sweep

SWEEP_PAYLOADS ?= 2000
.PHONY: sweep
sweep: all $(BUILD)/tests/test_report_sweep
	@ROTID_SWEEP_PAYLOADS=$(SWEEP_PAYLOADS) OPENBLAS_NUM_THREADS=1 $(BUILD)/tests/test_report_sweep

abi: $(BUILD)/tests/test_abi
	@$< --write $(if $(filter 1,$(UNRELEASED)),--unreleased)

.PHONY: fortran
fortran: $(BUILD)/tests/test_fortran
	@$< --write

# The table of options is that of the program, so the test of what follows from it links the program except its main.
$(BUILD)/tests/test_manual: $(call OBJECTS_OF,$(wildcard tools/tables/*.c) $(filter-out %/main.c,$(CLI_SOURCES)))
$(BUILD)/tools/tables/%.o: ALL_CFLAGS += -Itools
.PHONY: tables
tables: all $(BUILD)/tests/test_manual
	@$(BUILD)/tests/test_manual --write

demo: all
	@sh tools/demo $(BUILD)/rotid $(BUILD)/demo

figures: all
	@sh tools/figures $(BUILD)/rotid $(BUILD)/figures

# WITHOUT: names of programs that are left out. The longest first, else the others wait for them at the end.
LONGEST := $(addprefix $(BUILD)/tests/test_,diagnose_cases tutorial worked diagnose embedding evidence suggest diagnose_states page_browser \
           hidden_effects solid_frequencies limits chain runup weighed api_memory hidden_faults wrong_decks \
           api_cancel diagnose_model page_input host held_mesh diagnose_solid accelerometer study_program study_run install \
           running_bands fortran solid_attached diagnose_bounds api_diagnosis terminal ema_statistics deck_write command_ema run search)
# Dozens of diagnoses each, minutes in all: make test-long, once for each change of the diagnosis, and there all
# rows of LONGER.
LONGER := hidden_effects hidden_faults chain diagnose_cases diagnose api_cancel api_memory solid_frequencies held_mesh worked run deck_write search
LONG := hidden_numbers hidden_rivals hidden_pairs hidden_shifts stiff_supports power
TESTED = $(filter-out $(addprefix $(BUILD)/tests/test_,$(WITHOUT) $(LONG)),$(filter $(TEST_PROGRAMS),$(LONGEST)) $(filter-out $(LONGEST),$(TEST_PROGRAMS)))
test: test-programs
	@sh tools/run-tests $(TESTED)
.PHONY: test-programs
test-programs: all $(TESTED)
.PHONY: test-long
test-long: all $(addprefix $(BUILD)/tests/test_,$(LONG) $(LONGER))
	@ROTID_LONG=1 sh tools/run-tests $(addprefix $(BUILD)/tests/test_,$(LONG) $(LONGER))

bench bench-quick: all $(BUILD)/hide
	@sh tools/bench/run $(@:bench-%=%) $(BUILD)

# rotid_lm and MINPACK for callgrind
$(BUILD)/lm_host: $(BUILD)/tools/bench/lm_host.o $(BUILD)/tests/nist_regression.o $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ $(shell pkg-config --libs cminpack) $(LIBRARY_LIBS) -o $@
bench-check: $(if $(shell pkg-config --exists cminpack && echo yes),$(BUILD)/lm_host)
$(BUILD)/tools/bench/lm_host.o: ALL_CFLAGS += -Itests

# MINPACK driving the model of a deck, where its C version is installed; looks into the library, as tests do
$(BUILD)/fit_host: $(BUILD)/tools/bench/fit_host.o $(ROOMS) $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ $(shell pkg-config --libs cminpack) $(LIBRARY_LIBS) -o $@
$(BUILD)/tools/bench/%.o: ALL_CFLAGS += $(shell pkg-config --cflags cminpack)
bench: $(if $(shell pkg-config --exists cminpack && echo yes),$(BUILD)/fit_host)

# instructions of fixed runs, by callgrind, beside those of tools/bench/instructions.txt; RECORD=--record writes them anew
.PHONY: bench-check bench-growth
bench-growth: all
	@OPENBLAS_NUM_THREADS=1 $(PYTHON) tools/bench/growth.py $(BUILD)/rotid $(BUILD)
bench-check: all $(BUILD)/hide
	@$(PYTHON) tools/bench/instructions.py $(BUILD)/rotid $(BUILD)/hide $(BUILD) $(RECORD)

# without the programs that diagnose dozens of rotors, and those that count over hundreds of random cases, grids, fine meshes or
# figures, wait for terminals and clocks, run the commands of documents or build hosts: what they call is in the others.
# ASAN=all: with them, an hour. Of what `undefined` looks for, null, object sizes and pointers out of range are seen by `address` too,
# where they are used; those and alignment, which `make fuzz` looks for, take a quarter of the time.
DIAGNOSE_MANY := diagnose hidden_effects hidden_faults hidden_structures diagnose_cases diagnose_bounds diagnose_states \
                 diagnose_solid diagnose_model api_diagnosis held_mesh suggest chain posterior weighed runup page_diagnose
COUNT_MANY := worked tutorial manual evidence ema_statistics accelerometer roving_accelerometer hide solid_frequencies page_browser report_sweep \
              embedding fortran install host running_bands running running_cases solid_attached study_program study_run study_states study_data \
              page_input page_study effect_derivative causes_exact worth torsion shared_unknowns traps terminal limits modal_fit signal_noise \
              fit_bounds fit_truth paper_fit states_held_out threads
ASAN := $(DIAGNOSE_MANY) $(COUNT_MANY)
.PHONY: asan-programs
asan-programs check-asan:
	@FC=none $(MAKE) --no-print-directory BUILD=$(BUILD)/asan LDFLAGS='-fsanitize=address,undefined' \
	    CFLAGS='-O1 -g1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize=null,object-size,alignment,pointer-overflow -fno-sanitize-recover=all' \
	    WITHOUT='$(filter-out all,$(ASAN))' $(if $(filter check-asan,$@),test,test-programs)

# Calls from several threads under the thread sanitizer; where possible without address space randomisation, with which it does
# not start on kernels that randomise more bits than it knows of.
.PHONY: check-tsan
check-tsan:
	@$(MAKE) --no-print-directory BUILD=$(BUILD)/tsan LDFLAGS=-fsanitize=thread CFLAGS='-O0 -g1 -fsanitize=thread' $(BUILD)/tsan/tests/test_threads
	@OPENBLAS_NUM_THREADS=1 TSAN_OPTIONS=halt_on_error=1 $$(setarch -R true 2>/dev/null && echo setarch -R) $(BUILD)/tsan/tests/test_threads

# without those and other long ones
check-valgrind: all $(TEST_PROGRAMS)
	@ROTID_UNDER='valgrind -q --error-exitcode=99 --leak-check=full --suppressions=tests/valgrind.supp' \
	    sh tools/run-tests $(filter-out $(addprefix %/test_,$(DIAGNOSE_MANY) $(COUNT_MANY) $(LONG) api_cancel host study_run),$(TEST_PROGRAMS))

# beside MINPACK, where its C version is installed
$(BUILD)/minpack_peer: $(BUILD)/tests/peers/minpack_peer.o $(BUILD)/tests/more_garbow_hillstrom.o \
                       $(BUILD)/tests/mgh_functions.o $(BUILD)/tests/mgh_data_fits.o $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ $(shell pkg-config --libs cminpack) $(LIBRARY_LIBS) -o $@
$(BUILD)/tests/peers/%.o: ALL_CFLAGS += $(shell pkg-config --cflags cminpack)
check-peers: all $(BUILD)/hammer $(if $(shell pkg-config --exists cminpack && echo yes),$(BUILD)/minpack_peer)
	@sh tests/peers/run $(BUILD) $(PYTHON)

# beside bricks of CalculiX, where that is installed: four minutes
.PHONY: check-solid3d
check-solid3d: all
	@$(PYTHON) tools/solid3d/check.py $(BUILD)/rotid
	@$(PYTHON) tools/solid3d/rotation.py $(BUILD)/rotid

# Effects hidden in solids by elements that share nothing with src, and what becomes of them; POWER as above, such as "--cases 60
# --seed 2". NumPy and SciPy go into the build folder, which needs the network once.
.PHONY: power-solid coverage-solid
$(BUILD)/venv-solid/ready:
	@$(PYTHON) -m venv $(@D) && $(@D)/bin/python -m pip install -q --disable-pip-version-check numpy scipy && touch $@
power-solid coverage-solid: all $(BUILD)/venv-solid/ready
	@$(BUILD)/venv-solid/bin/python tools/hide-solid/check.py
	@$(BUILD)/venv-solid/bin/python tools/hide-solid/power.py $(BUILD)/rotid $(BUILD)/$@ $(if $(findstring coverage,$@),--coverage 100) $(POWER)

# the tests of linear algebra, fits and decks with reference LAPACK and, where installed, BLIS
.PHONY: check-blas
check-blas:
	@sh tests/blas/check '$(BUILD)'

check-embedding: all $(BUILD)/tests/test_fortran $(BUILD)/tests/test_embedding
	@sh tests/embedding/check '$(BUILD)'

# Starts from the corpus in tests/fuzz; what is new goes into the build folder, what fails is written into crash-* there.
FUZZERS := uff import deck table suggest plan results
FUZZ_PROGRAMS := $(addprefix $(BUILD)/tests/fuzz/fuzz_,$(FUZZERS))
$(FUZZ_PROGRAMS): %: %.o $(BUILD)/tests/fuzz_one.o $(ROOMS) $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ $(PROGRAM_LIBS) -o $@
fuzzers: $(FUZZ_PROGRAMS)
fuzz:
	@$(MAKE) --no-print-directory BUILD=$(BUILD)/fuzz CC=$(FUZZ_CC) LDFLAGS='-fsanitize=fuzzer,address,undefined' \
	    CFLAGS='-O1 -g -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all' fuzzers
	@for name in $(FUZZERS); do mkdir -p $(BUILD)/fuzz/corpus/$$name && \
	    seeds=$$(test $$name = import && echo uff || echo $$name) && \
	    OPENBLAS_NUM_THREADS=1 $(BUILD)/fuzz/tests/fuzz/fuzz_$$name -max_total_time=$(FUZZ_SECONDS) -timeout=20 -rss_limit_mb=1024 \
	    -max_len=65536 -print_final_stats=1 -artifact_prefix=$(BUILD)/fuzz/ $(BUILD)/fuzz/corpus/$$name \
	    tests/fuzz/corpus/$$seeds || exit 1; done

# Outputs of all commands on all decks beside those of another commit: FROZEN="--only identify ema" for some, --long for all.
.PHONY: frozen
frozen: all
	@$(PYTHON) tools/frozen '$(BUILD)' $(REF) $(FROZEN)

# Would the tests fail? ROWS: parts of file names, tests or line numbers of the list.
.PHONY: mutate
mutate:
	@$(PYTHON) tools/mutate '$(BUILD)' $(ROWS)

coverage:
	@$(MAKE) --no-print-directory BUILD=$(BUILD)/coverage CFLAGS='-O0 -g --coverage' LDFLAGS=--coverage test
	@sh tools/coverage $(BUILD)/coverage

# docs/schema, from the tables of src/record and src/result and the comments of the structs that they describe
SCHEMA_HEADERS := include/rotid.h $(wildcard src/result/*.h src/result/*.def) src/run/run.h src/running/running.h
$(BUILD)/tools/schema/%.o: ALL_CFLAGS += -Itools/schema
$(BUILD)/schema: $(call OBJECTS_OF,$(wildcard tools/schema/*.c)) $(PROGRAM_OBJECTS) $(OBJECTS)
	$(call tell,LD,$@)
	$(QUIET)$(CC) $(CFLAGS) $(LDFLAGS) $^ $(PROGRAM_LIBS) -o $@
schema: $(BUILD)/schema
	@$(BUILD)/schema docs/schema $(SCHEMA_HEADERS)
# test_schema compares them with docs/schema
$(BUILD)/tests/test_schema.o: ALL_CFLAGS += -DROTID_SCHEMA_HEADERS='"$(SCHEMA_HEADERS)"'
$(BUILD)/tests/test_schema: | $(BUILD)/schema

lint:
	$(CLANG_TIDY) --quiet $(LIBRARY_SOURCES) $(PROGRAM_SOURCES) $(CLI_SOURCES) -- $(ALL_CFLAGS) $(EXTRA_blas) -DROTID_COMMIT='""'
	@sh tools/lint-manual

format:
	$(CLANG_FORMAT) -i $(wildcard src/*/*.[ch] include/*.h tests/*.[ch] tests/*/*.[ch] tools/*/*.[ch])

install: all
	@$(TELL_INSTALL) sh tools/install install '$(BUILD)'
uninstall:
	@$(TELL_INSTALL) sh tools/install uninstall '$(BUILD)'
TELL_INSTALL = $(foreach name,VERSION SONAME DESTDIR PREFIX BINDIR LIBDIR PKGCONFIGDIR CMAKEDIR INCLUDEDIR DATADIR MANDIR DOCDIR BASHDIR ZSHDIR \
               FISHDIR MPI,$(name)='$($(name))')

clean:
	rm -rf $(BUILD)

-include $(shell find $(BUILD) -type f -name '*.d' 2>/dev/null)
