# book/book.mk  4  the book: its pages, their still pictures and the verdicts of its tests; slides
.PHONY: book slides
book: $(PENUMBRA) $(JUDGES) $(JUDGES:$(COURSE)/judge_%=$(COURSE)/answers_%) $(filter web,$(MAKECMDGOALS))  ## the book to learn from alone: out/book/index.html; make web book: with live figures
	@python3 src/book/book.py out/book

slides:  ## for instructors: a deck for each session of the course, with notes: build/slides/index.html (pandoc)
	@python3 src/book/slides.py build/slides
