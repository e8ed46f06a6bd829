# make study   sets up and runs the default study      make quick   the same DAG in minutes
# make test    sets up and runs the tests               make paper   the paper's full size, hours
# make peers   LMGC90 and MuJoCo, for comparisons alone: docs/results/peers.md
PYTHON ?= python3
CORES ?= $(shell nproc)
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready
PEERS := .venv-peers
ESTIMATE := logs/paper/estimate.txt
SNAKEMAKE = PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakemake --cores $(CORES)

.PHONY: study quick paper examples audit test test-workflow test-slow test-faults test-faults-few test-cluster test-hidden-few test-hidden bench bench-scale figures-of-docs peers cluster setup lint lock clean

study: setup
	@$(BIN)/blockshake check config/study.yaml
	$(SNAKEMAKE) --configfile config/study.yaml
	@echo "The report: $(CURDIR)/reports/study.html and study.pdf"

quick: setup
	@$(BIN)/blockshake check config/quick.yaml
	$(SNAKEMAKE) --configfile config/quick.yaml
	@echo "The report: $(CURDIR)/reports/quick.html and quick.pdf"

# the estimate takes minutes, so it is kept: made anew when the study changes
paper: setup $(ESTIMATE)
	@cat $(ESTIMATE)
	$(SNAKEMAKE) --configfile config/paper.yaml
	@echo "The report: $(CURDIR)/reports/paper.html and paper.pdf"

$(ESTIMATE): config/paper.yaml | setup
	@$(BIN)/blockshake check config/paper.yaml
	@echo "Trying its simulations, to say how long it takes: some minutes ..."
	@mkdir -p $(@D)
	@$(BIN)/blockshake estimate config/paper.yaml --cores $(CORES) > $@.part && mv $@.part $@

# one rocking block, an own wall under an own record, own tests from spreadsheets to a verdict: minutes
examples: setup
	$(BIN)/python examples/rocking_block.py
	$(BIN)/python examples/own_wall.py results/examples/own-wall
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python examples/own_campaign.py results/examples/own-campaign

# laws and behaviours; then all that starts Snakemake, processes, a browser or an installation
PARALLEL = --numprocesses $(CORES) --dist loadfile --no-loadscope-reorder
OTHERS = not slow and not hidden_effects and not faults and not short_faults and not cluster

test: setup
	$(BIN)/pytest -m "$(OTHERS) and not workflow" $(PARALLEL)

test-workflow: setup
	$(BIN)/pytest -m "$(OTHERS) and workflow" $(PARALLEL)

test-slow: setup
	$(BIN)/pytest -m slow

# a small study and a small diagnosis, each killed at MOMENTS moments, interrupted and edited, the study damaged and on
# a full disk too: long; prints what was done and what was lost, and writes it to docs/results/faults.md
MOMENTS ?= 20
test-faults: setup
	PATH="$(CURDIR)/$(BIN):$$PATH" BLOCKSHAKE_MOMENTS=$(MOMENTS) $(BIN)/pytest -m faults
	$(BIN)/python bench/figures_of_docs.py faults

# the shorter ones of these tests, on a study, with two kills, and workflows that fail: minutes
test-faults-few: setup
	PATH="$(CURDIR)/$(BIN):$$PATH" BLOCKSHAKE_MOMENTS=2 $(BIN)/pytest -m short_faults

# a small study through a SLURM of one node on this machine, from Debian's slurmctld, slurmd, slurm-client and munge:
# tens of minutes; skipped where they are not installed
test-cluster: cluster
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/pytest -m cluster

# four campaigns with and without a hidden effect, diagnosed as a user would, and a short one of every class: minutes
test-hidden-few: setup
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/pytest -m hidden_effects

# all cases of hidden_effects/seeds.yaml, and the track record that reports print: long, resumable;
# ARGUMENTS="--share 1/4" takes a fourth of them, "--laboratory mujoco" those of one laboratory
test-hidden: setup peers
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python hidden_effects/measure_track_record.py --cores $(CORES) $(ARGUMENTS)

# how fast the solvers are on this machine, for maintainers: minutes on a machine that does nothing else;
# ARGUMENTS=--accept keeps the figures
bench: setup
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python bench/bench.py $(ARGUMENTS)

# the largest works on one machine, their memory and CPU time: ten thousand samples, an hour of motion, 2,000 blocks,
# 10,000 draws; ARGUMENTS=--accept keeps the table
bench-scale: setup
	PATH="$(CURDIR)/$(BIN):$$PATH" OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python bench/scale.py $(ARGUMENTS)

# the figures in docs/ that the program makes, written to their pages: minutes; findings on the paper after a study
figures-of-docs: setup
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python bench/figures_of_docs.py
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python bench/figure_overview.py

# other people's programs, under their own licences, in an environment of their own; nothing else needs it
peers: $(PEERS)/ready

$(PEERS)/ready:
	@echo "Setting up $(PEERS) ..."
	@$(PYTHON) -m venv --clear $(PEERS)
	@$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check numpy mujoco==4.0.0
	@$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps compas_lmgc90==0.1.11
	@touch $@

# adds Snakemake's executor for SLURM to the environment: docs/guide/cluster.md
cluster: $(VENV)/cluster

$(VENV)/cluster: $(READY)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-build-isolation -e '.[cluster]'
	@touch $@

setup: $(READY)

# made anew when the lock or the package's description changes; a set-up cut short leaves no mark
$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "blockshake needs Python 3.11 or newer; set PYTHON=...")'
	@echo "Setting up $(VENV) ..."
	@$(PYTHON) -m venv --clear $(VENV)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $(READY)
	@echo "Ready: $(BIN)/blockshake --help, or make quick"

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint

# for maintainers: needs uv; the lock holds for Python 3.11 to 3.13
lock:
	uv pip compile pyproject.toml --extra test --extra build --universal --python-version 3.11 --generate-hashes \
	  --no-annotate --no-header --no-emit-index-url --no-emit-find-links -o requirements.lock

# known vulnerabilities of the locked packages, by the advisories of the Python package index; says so where it has none
audit:
	@$(PYTHON) -m venv --clear .venv-audit
	@.venv-audit/bin/python -m pip install --quiet --disable-pip-version-check pip-audit==2.10.1
	@.venv-audit/bin/python .ci/audit.py

clean:
	rm -rf results reports logs .snakemake
