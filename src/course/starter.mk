# course/starter.mk  5  the Makefile of a starter: `make` draws pictures, `make check` says what is right
CXX      ?= g++
REAL     ?= double
# Compilers for other processors do not know this one.  Who needs a flag for fma, knows this flag.
NATIVE   := $(shell $(CXX) -x c++ -march=native -fsyntax-only /dev/null >/dev/null 2>&1 && echo -march=native)
HOMEBREW := $(addprefix -idirafter ,$(addsuffix /include,$(shell brew --prefix 2>/dev/null)))
FLAGS    := -std=c++20 $(NATIVE) -ffp-contract=off -fno-math-errno -pthread -DREAL=$(REAL) -Isrc -MMD -MP \
            -Wall -Wextra -Wpedantic -Wshadow $(HOMEBREW)
SUFFIX   := $(if $(filter float,$(REAL)),-float)$(if $(DEBUG),-debug)
SCENES   := $(patsubst scenes/%.scene,%,$(wildcard scenes/*.scene))
ifeq ($(MAKELEVEL)$(filter -j%,$(MAKEFLAGS)),0)
  MAKEFLAGS += -j$(shell nproc 2>/dev/null || sysctl -n hw.ncpu 2>/dev/null || echo 2)
endif

.PHONY: all clean help packages penumbra report
.DELETE_ON_ERROR:
.SECONDARY:

all: build/penumbra$(SUFFIX)  ## render every scene into out/ (default)
	@mkdir -p out; for s in $(SCENES); do build/penumbra$(SUFFIX) --spp 16 -o out/$$s.png scenes/$$s.scene || exit 1; done

out/%.png: scenes/%.scene build/penumbra$(SUFFIX)  ## out/NAME.png: render scenes/NAME.scene; ARGS="--spp 64": build/penumbra --help has more
	@mkdir -p out; build/penumbra$(SUFFIX) $(or $(ARGS),--spp 16) -o $@ $<

penumbra: build/penumbra$(SUFFIX)  ## build the renderer alone; DEBUG=1: build/penumbra-debug, for a debugger, with assertions
	@echo $<
$(if $(SUFFIX),build/penumbra: penumbra)

# A program is a .cpp of its own name: penumbra, and those of the projects.
define program
build/$(basename $(notdir $(1)))$(SUFFIX): $(1) build/compiler$(SUFFIX) | packages
	@$$(CXX) $$(FLAGS) $$(BRIEFLY) -MF $$@.d -MT $$@ -o $$@ $$<
endef
$(foreach source,$(filter-out src/web/%,$(wildcard src/*/*.cpp)),$(eval $(call program,$(source))))
-include $(wildcard build/*.d)

report:  ## out/report/index.html to hand in: verdicts, pictures beside the expected ones, your answers in answers.md; WEEKS=1-3
	@MAKE='$(MAKE)' SUFFIX=$(SUFFIX) tests/course/report $(WEEKS)

clean:  ## remove build/ and out/
	rm -rf build out

help:  ## print this
	@echo "make TARGET [CXX=g++|clang++] [REAL=double|float] [DEBUG=1]"
	@awk -F '  ## ' '/^[a-z].*  ## / { t = $$1; sub(/[: ].*/, "", t); if (t ~ /^out/) { t = "out/NAME.png"; sub(/^[^:]*: /, "", $$2) } printf "  %-14s %s\n", t, $$2 }' Makefile src/course/course.mk src/web/web.mk

# stb_image_write writes PNG files.
packages:
	@command -v $(firstword $(CXX)) >/dev/null || { echo "no compiler $(CXX): install it, or say make CXX=..." >&2; exit 1; }
	@printf '\043include <stb/stb_image_write.h>\n' | $(CXX) -x c++ -Isrc $(HOMEBREW) -fsyntax-only - 2>/dev/null || \
	    { echo "install stb (stb/stb_image_write.h); on Debian or Ubuntu: sudo apt-get install libstb-dev" >&2; exit 1; }

include src/course/course.mk
include src/web/web.mk
