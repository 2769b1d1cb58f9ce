#!/usr/bin/env bash
# Installs the grader beside this script, once: Gradescope does it when it builds its image.
# Only pinned packages are installed, with the hashes that requirements.lock names.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

find_python() {
    local name
    for name in "${PYTHON:-python3.14}" python3.13 python3.12 python3.11 python3; do
        if "$name" -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            echo "$name"
            return
        fi
    done
    return 1
}

# Ubuntu 22.04 has Python 3.10 as python3, and 3.11 beside it.
if ! python=$(find_python); then
    apt-get update
    apt-get install -y python3.11 python3.11-venv || apt-get install -y python3 python3-venv
    python=$(find_python)
fi

"$python" -m venv venv
venv/bin/python -m pip install --quiet --require-hashes -r requirements.lock
venv/bin/python -m pip install --quiet --no-index --no-deps --force-reinstall ./dh_grader-*.whl
venv/bin/dh-grader --version
