# One virtual environment, built from the lock files; `make` alone lists the targets.
# Everything runs as `python -m …`: scripts' first lines break in a path with spaces.

PYTHON ?= python3
VENV   ?= .venv
HOST   ?= $(or $(DH_GRADER_HOST),127.0.0.1)
PORT   ?= $(or $(DH_GRADER_PORT),8000)
COUNT  ?= 100000
TABLES ?= 1000
ROBOTS ?= 5000
SEEDS  ?= 10000
SEED   ?= 1
MINUTES ?= 10
SECONDS ?= 60
SAMPLE ?= 100
HANDINS ?= 300
BASE ?= HEAD

python  := "$(VENV)/bin/python"
install := $(python) -m pip install --quiet --disable-pip-version-check

# A stamp is written last, inside the environment: an interrupted install leaves none and is redone,
# and rebuilding the environment drops both. $(space) keeps an overridden VENV with spaces one word.
empty   :=
space   := $(empty) $(empty)
stamps  := $(subst $(space),\$(space),$(VENV))
runtime := $(stamps)/.runtime-installed
dev     := $(stamps)/.dev-installed

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help install run test long thorough browser screenshots coverage lint format pages bench fuzz attack probe load sizing worst campaign rows sums policies prints slips tables handins same robots mutants durability attempts clients wheel image lock clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "  make %-10s %s\n", $$1, $$2 }' Makefile

install: $(dev) ## create .venv with everything for work on the project

run: $(runtime) ## start the service on http://127.0.0.1:8000 (HOST=, PORT=)
	$(python) -m dh_grader serve --host "$(HOST)" --port "$(PORT)"

# A worker that has finished takes over tests of another.
pytest := $(python) -m pytest -n auto --dist worksteal
ruff   := $(python) -m ruff check . && $(python) -m ruff format --check .

# The types are checked beside the tests, on one of the cores; what is said of them comes last.
test: $(dev) ## lint, type-check and test on every core
	$(ruff)
	-@$(python) -m tests.browser.chromium
	@types=$$(mktemp) && trap 'rm -f "$$types"' EXIT && { \
	$(python) -m mypy >"$$types" 2>&1 & checker=$$!; \
	echo '$(pytest)'; $(pytest); tested=$$?; \
	wait $$checker; checked=$$?; cat "$$types"; [ $$tested = 0 ] && [ $$checked = 0 ]; }

long: $(dev) ## the tests that take seconds: browsers, processes, samples of campaigns
	$(pytest) -m "long and not campaign"

thorough: $(dev) ## the same tests, and all of which the suite has a sample (takes long)
	$(pytest) -m "campaign or not campaign" --hypothesis-profile thorough --ignore tests/installed

browser: $(dev) ## say which Chromium the browser tests use; fetch one from npm where there is none
	$(python) -m tests.browser.chromium

screenshots: $(dev) ## photograph every view into docs/screenshots
	$(python) -m tests.browser.screenshots

coverage: $(dev) ## the same tests, and the lines that none of them runs (twice the time)
	$(pytest) -m "not campaign" --cov

lint: $(dev) ## ruff, mypy and the checks of the scripts, without the tests
	$(ruff)
	$(python) -m tests.front.deno
	$(python) -m mypy

format: $(dev) ## rewrite the code in the house style
	$(python) -m ruff check --fix .
	$(python) -m ruff format .
	$(python) -m tests.front.deno --fix

# A page is replaced only after it was written as a whole.
written = $(python) -m $(1) >"$(2).new" && mv "$(2).new" "$(2)"

pages: $(dev) ## write all that is made from the code: pages of docs, types of scripts, catalogues
	$(python) -m tests.docs.misconception_records
	$(python) -m tests.api.rights_table
	$(call written,tests.docs.sentences,docs/sentences.md)
	$(call written,tests.docs.exercise_fields,docs/exercise-fields.md)
	$(call written,tests.docs.settings,docs/settings.md)
	$(call written,tests.docs.problems,docs/problems.md)
	$(call written,tests.docs.notice,NOTICE)
	$(call written,tests.catalogue.checked,exercises/checked.json)
	$(call written,tests.front.api_types,service/dh_grader/web/types/api.d.ts)
	$(python) -m tests.translations.catalogues

bench: $(dev) ## measure against the budgets
	$(python) -m tests.benchmarks

fuzz: $(dev) ## read 100,000 hostile texts, grids and requests on every core (COUNT=, SEED=)
	$(python) -m tests.fuzz --count "$(COUNT)" --seed "$(SEED)"

attack: $(dev) ## attack a real process; look for misread formulas; watch the memory (COUNT=)
	$(python) -m tests.attack
	$(python) -m tests.attack.misreadings
	$(python) -m tests.attack.memory --count "$(COUNT)"
	$(python) -m tests.attack.memory --count 10000 --http

probe: $(dev) ## count the seconds until this server, and others, close seven slow clients (network)
	$(python) -m tests.server.probe

load: $(dev) ## 200 clients for SECONDS= (60), graded and recorded, on SQLite and on two replicas over PostgreSQL
	$(python) -m tests.load --seconds "$(SECONDS)"
	$(python) -m tests.load --seconds "$(SECONDS)" --database postgresql --replicas 2 --workers 1
	$(python) -m tests.load.wrong_answers

sizing: $(dev) ## simulate a deadline with measured times: how many students one, two and eight processes hold
	$(python) -m tests.load.sizing
	$(python) -m tests.courses.hand_ins.last_minute
	$(python) -m tests.lti.load.rush
	$(python) -m pytest -m campaign tests/load tests/lti/test_outbox.py

worst: $(dev) ## search for the costliest request for MINUTES= (10), and say where its time goes (SEED=)
	$(python) -m tests.worst --minutes "$(MINUTES)" --seed "$(SEED)"

campaign: $(dev) ## grade tables in random frames, TABLES= of each robot and convention (SEED=)
	$(python) -m tests.frame_choice --tables "$(TABLES)" --seed "$(SEED)"

rows: $(dev) ## grade tables with one wrong row; leave rows and cells of wrong tables empty (SEED=)
	$(python) -m tests.frame_choice.rows.one_row --tables 5000 --seed "$(SEED)"
	$(python) -m tests.frame_choice.rows.blanking --tries 20000 --seed "$(SEED)"
	$(python) -m tests.frame_choice.rows.careless --seed "$(SEED)"

sums: $(dev) ## hand in 1,000 random wrong answers to the tables of each exercise: do the points add up? (SEED=)
	$(python) -m tests.grading.sums --tables --seed "$(SEED)"

policies: $(dev) ## grade tables of ROBOTS= unseen robots under each policy, 20 draws each (SEED=)
	$(python) -m tests.frame_choice.by_policy --robots "$(ROBOTS)" --seed "$(SEED)"

clients: $(dev) ## lint the OpenAPI document and use clients that are generated from it (npx, network)
	$(python) -m tests.clients

wheel: $(dev) ## install the built wheel with pip and pipx on every Python that is there (network)
	$(python) -m tests.installed
	$(python) -m pytest -m campaign tests/installed

slips: $(dev) ## spoil the poses of all robots, and of random ones, by each slip of the table: is it named?
	$(python) -m tests.pose_slips --show
	$(python) -m tests.pose_slips.unseen --arms 200 --show

tables: $(dev) ## import 500 tables, typed by people and by programs: is it the same robot? (SEED=)
	$(python) -m tests.importing.tables --tables 500 --seed "$(SEED)"

handins: $(dev) ## hand in HANDINS= files of all kinds as four platforms name them: are they graded right? (SEED=)
	$(python) -m tests.submissions.handins --count "$(HANDINS)" --seed "$(SEED)"

same: $(dev) ## ask this checkout and the commit BASE= the same: reports, previews, pages, commands
	$(python) -m tests.same --base "$(BASE)"

robots: $(dev) ## draw SEEDS= practice robots of each level: statement, marks, links, labels, forms
	for level in 1 2 3 4; do $(python) -m tests.variants.robots --level $$level --seeds "$(SEEDS)" || exit; done

mutants: $(dev) ## change rights, marks and comparisons in small ways: does a test notice? (SAMPLE=, SEED=, PACKAGES=, RESUME=)
	$(python) -m tests.mutants $(PACKAGES) --sample "$(SAMPLE)" --seed "$(SEED)" $(if $(RESUME),--resume "$(RESUME)")

durability: $(dev) ## kill the service while it records, and restores, backups, regrades, deletions and migrations, 20 times each
	$(python) -m pytest -m campaign tests/store/test_durability.py tests/store/test_kills.py tests/store/test_two_versions.py tests/courses/hand_ins/test_hand_ins.py tests/store/test_migrations.py tests/lti/test_outbox.py

attempts: $(dev) ## measure a store of COUNT= attempts; regrade as many by four processes, two being killed
	$(python) -m tests.store.campaign --count "$(COUNT)"
	$(python) -m tests.store.shared_regrade --count "$(COUNT)"

prints: $(dev) ## hand in the model solution of every exercise as each program prints it
	$(python) -m tests.solutions.prints

image: $(dev) ## build the image and try it: no root, nothing to write to, health (docker, podman or buildah)
	$(python) -m tests.installed.image

# Only pins that pyproject.toml no longer allows are changed; `make lock UPGRADE=--upgrade` takes the newest.
# One resolution serves every Python and platform; later files repeat the pins of earlier ones.
compile = "$$tmp/bin/python" -m uv pip compile --quiet --universal --python-version 3.11 --no-strip-extras --generate-hashes \
	--no-header --no-emit-index-url --no-emit-find-links --no-annotate $(UPGRADE)
lock: ## regenerate the lock files (UPGRADE=--upgrade for the newest versions)
	@tmp=$$(mktemp -d) && trap 'rm -rf "$$tmp"' EXIT && \
	$(PYTHON) -m venv "$$tmp" && "$$tmp/bin/python" -m pip install --quiet uv && \
	$(compile) pyproject.toml -o requirements.lock && \
	$(compile) --group pyproject.toml:build -o requirements-build.lock && \
	$(compile) pyproject.toml --group dev -c requirements.lock -c requirements-build.lock -o requirements-dev.lock

clean: ## remove .venv and every cache
	@[ ! -e "$(VENV)" ] || [ -f "$(VENV)/pyvenv.cfg" ] || { echo '$(VENV) is no virtual environment; not removed.'; exit 1; }
	rm -rf "$(VENV)" .coverage .hypothesis .mypy_cache .pytest_cache .ruff_cache build dist
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
	rm -f service/dh_grader/translations/*/*.mo

$(runtime): pyproject.toml requirements.lock requirements-build.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo \
	  'DH Grader needs Python 3.11 or newer, and "$(PYTHON)" is not. Name one: make PYTHON=python3.12 …' >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { echo \
	  '"$(PYTHON)" cannot create virtual environments. Install its venv module (on Debian: apt install python3-venv).' >&2; exit 1; }
	@[ ! -e "$(VENV)" ] || [ -f "$(VENV)/pyvenv.cfg" ] || { echo \
	  '"$(VENV)" exists and is no virtual environment. Remove it, or choose another place: make VENV=… …' >&2; exit 1; }
	$(PYTHON) -m venv --clear "$(VENV)"
	$(install) --require-hashes -r requirements.lock -r requirements-build.lock
	$(install) --no-deps --no-build-isolation --editable .
	@touch "$@"

$(dev): $(runtime) requirements-dev.lock
	$(install) --require-hashes -r requirements-dev.lock
	@touch "$@"
