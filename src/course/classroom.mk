# course/classroom.mk  16  what teachers make: starters, sheets, grades, bug hunts
include src/course/course.mk
JUDGES := $(patsubst tests/course/%.cpp,$(COURSE)/%,$(wildcard tests/course/judge_*.cpp))

# What the solution draws, students compare with.  They have the plain BVH.
DRAWN_BY := $(if $(filter float,$(REAL)),-float)-plain$(VARIANT)
.PHONY: drawers starter starter-check mistakes handout key grade autograder plant hunted
drawers:
	@$(MAKE) --no-print-directory TREE=plain build/penumbra$(DRAWN_BY) build/shadow$(DRAWN_BY)

starter:  ## write the students' starter, build/starter/ and .tar.gz; WEEKS=1-3: these weeks, with earlier weeks solved
	@DRAW_SUFFIX=$(DRAWN_BY) python3 src/course/starter.py $(if $(WEEKS),--weeks '$(WEEKS)') build/starter
starter: drawers

# Students' code is compiled and run in a sandbox alone: SANDBOX=namespaces or user, or what this machine has.
grade: packages  ## grade submissions: SUBMISSIONS=FOLDER; OUT=FOLDER-grades, WEEKS=1-3, SEED=N, JOBS=2
	@$(if $(SUBMISSIONS),,echo "make grade SUBMISSIONS=FOLDER: a folder or a .tar.gz for each student" >&2; exit 2;) \
	CXX="$(CXX)" FLAGS="$(filter-out -M% -W%,$(FLAGS)) -Itests -w -O1" python3 src/course/grade.py \
	    $(if $(OUT),--out '$(OUT)') $(if $(WEEKS),--weeks '$(WEEKS)') $(if $(SEED),--seed $(SEED)) \
	    $(if $(JOBS),--jobs $(JOBS)) $(if $(SANDBOX),--sandbox $(SANDBOX)) '$(SUBMISSIONS)'

# Gradescope's machines differ: what one compiles, another must run.
autograder:  ## write the zip that Gradescope takes: build/autograder-1.zip for WEEKS=1; VISIBILITY=after_published, SEED=N, BOARD=FILE
	@mkdir -p build; FLAGS="$(filter-out -M% -W% -march=%,$(FLAGS)) -Itests -w -O1" python3 src/course/autograder.py pack \
	    $(if $(WEEKS),--weeks '$(WEEKS)') $(if $(SEED),--seed $(SEED)) $(if $(VISIBILITY),--visibility $(VISIBILITY)) $(if $(BOARD),--board '$(BOARD)') 'build/autograder-$(or $(WEEKS),1-6).zip'

plant:  ## write a bug hunt: a solved copy with one mutant, as build/plant/N/ and .tar.gz; M=NAME or M=random, WEEKS=1-3
	@$(if $(M),,echo "make plant M=NAME: which of tests/mutants/?  M=random draws one" >&2; exit 2;) \
	CXX='$(CXX)' SUFFIX=$(SUFFIX) DRAW_SUFFIX=$(DRAWN_BY) python3 src/course/plant.py --mutant '$(M)' $(if $(WEEKS),--weeks '$(WEEKS)') build/plant
plant: drawers

hunted: packages  ## grade a bug hunt; N=3: of the copy build/plant/3, HUNT=FILE: the submitted test
	@$(if $(and $(N),$(HUNT)),,echo "make hunted N=NUMBER HUNT=FILE: which copy, and its test?" >&2; exit 2;) \
	CXX="$(CXX)" FLAGS="$(filter-out -M% -W%,$(FLAGS)) -Itests -w -O1" python3 src/course/hunted.py 'build/plant/$(N)' '$(HUNT)'

mistakes:  ## regenerate the table of known mistakes, tests/course/mistakes.txt (half an hour)
	@CXX='$(CXX)' FLAGS='$(FLAGS)' SUFFIX=$(SUFFIX) python3 src/course/mistakes.py $(if $(EX),--only '$(EX)')
mistakes: $(JUDGES) $(JUDGES:$(COURSE)/judge_%=$(COURSE)/answers_%)

handout:  ## sheets for students as HTML, and as PDF where Chromium is installed: build/handout/index.html; PAPER=letter
	@python3 src/course/handout.py $(if $(PAPER),--paper $(PAPER)) build/handout

key:  ## for instructors: the sheets with their answers, plans of the sessions, grading: build/key/index.html; PAPER=letter
	@python3 src/course/handout.py --key $(if $(PAPER),--paper $(PAPER)) build/key

starter-check:  ## test the starter; FULL=1: each pair of stubs, too
	@CXX='$(CXX)' FLAGS='$(FLAGS)' SUFFIX=$(SUFFIX) python3 src/course/starter_check.py $(if $(FULL),--full) $(if $(DRAW),--draw '$(DRAW)')
starter-check: $(JUDGES) $(JUDGES:$(COURSE)/judge_%=$(COURSE)/answers_%)
