# book/book.mk  3  the book: its pages, their still pictures and the verdicts of its tests
.PHONY: book
book: $(PENUMBRA) $(JUDGES) $(JUDGES:$(COURSE)/judge_%=$(COURSE)/answers_%) $(filter web,$(MAKECMDGOALS))  ## the book to learn from alone: out/book/index.html; make web book: with live figures
	@python3 src/book/book.py out/book
