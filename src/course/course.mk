# course/course.mk  4  how exercises are built and checked: for the solution's Makefile and the starter's
COURSE := build/course$(SUFFIX)
BRIEFLY = $(if $(DEBUG),-Og -g -D_GLIBCXX_ASSERTIONS,-O1)

# Another compiler builds anew.
build/compiler$(SUFFIX): always
	@mkdir -p $(@D); echo '$(CXX)' | cmp -s - $@ || echo '$(CXX)' >$@

# To be read by students as their compiler says it, and soon done: little is optimised.
$(COURSE)/%: tests/course/%.cpp build/compiler$(SUFFIX) | packages
	@mkdir -p $(@D)
	@$(CXX) $(FLAGS) $(BRIEFLY) -Itests -MF $@.d -MT $@ -o $@ $<

-include $(wildcard $(COURSE)/*.d)

.PHONY: check update always
check:  ## EX=2.1: is that exercise right?  WATCH=1: again at every save.  Without EX: what is right, wrong, open
	@MAKE='$(MAKE)' SUFFIX=$(SUFFIX) tests/course/check $(if $(WATCH),--watch) $(EX) || [ $$? = 1 ]

update:  ## STARTER=FILE.tar.gz: take a later week's starter into this folder, and keep what you wrote
	@tests/course/update '$(STARTER)'
