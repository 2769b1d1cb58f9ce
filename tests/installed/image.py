"""Build the image and run the service in it: ``make image``."""

# This needs root, Debian's `buildah` and `debootstrap`, the package indexes of Debian and Python,
# and three minutes. If no base image can be pulled, a bootstrapped Debian replaces it. The service
# runs as the user of the image, on a read-only root file system.

import json
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.installed.environment import ROOT

SUITE = "bookworm"
PACKAGES = "ca-certificates,python3,python3-pip,python3-venv"
# Files of this machine that builds need: certificates, and the configuration of pip.
BORROWED = ("/etc/ssl/certs", "/etc/pip.conf")

# The script that runs in the image, with the submission as standard input.
TRIAL = """
id -u
for place in /tmp /srv /opt/dh-grader; do
    touch "$place/x" 2>/dev/null && echo "$place is writable"
done
dh-grader grade - --exercise stanford-arm --format jsonl
python -m dh_grader serve >/dev/null & service=$!
for _ in $(seq 60); do python -m dh_grader.server.alive && break; sleep 1; done
python -m dh_grader.server.alive; echo "health $?"
kill -TERM "$service"; wait "$service"; echo "end $?"
"""
# The mounts end together with their namespace.
ENTER = """
mount --bind "$0" "$0" && mount -t proc proc "$0/proc" && mount --bind /dev "$0/dev" &&
mount -o remount,ro,bind "$0" && exec chroot --userspec="$1" "$0" env -i "${@:3}" bash -c "$2"
"""


class Builder:
    """Runs the program buildah with a storage folder of its own."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._store = ("--root", folder / "images", "--runroot", folder / "run")

    def __call__(self, *words: object) -> str:
        command = [str(word) for word in ("buildah", *self._store, *words)]
        settings = {"STORAGE_DRIVER": "vfs", "BUILDAH_ISOLATION": "chroot"}
        done = subprocess.run(
            command, env=os.environ | settings, stdout=subprocess.PIPE, text=True, check=True
        )
        return done.stdout.strip()

    def stand_in(self, folder: Path, name: str) -> None:
        options = ("--variant=minbase", f"--include={PACKAGES}", SUITE, str(folder))
        subprocess.run(("debootstrap", *options), stdout=subprocess.DEVNULL, check=True)
        (folder / "usr/bin/python").symlink_to("python3")
        for marker in folder.glob("usr/lib/python3*/EXTERNALLY-MANAGED"):
            marker.unlink()
        container = self("from", "scratch")
        self("add", "--quiet", container, folder, "/")
        self("commit", "--quiet", container, f"docker.io/library/{name}")

    def image(self, context: Path) -> str:
        """Build a Dockerfile and return the path of the image's files."""
        borrowed = [f"--volume={path}:{path}:ro" for path in BORROWED if Path(path).exists()]
        # The stand-in has another digest than the base image.
        undigested = self._folder / "Dockerfile"
        text = (context / "Dockerfile").read_text(encoding="utf-8")
        undigested.write_text(re.sub("@sha256:[0-9a-f]{64}", "", text), encoding="utf-8")
        options = ("--pull-never", *borrowed, "--tag", "dh-grader", "--file", undigested)
        self("bud", "--quiet", *options, context)
        return self("mount", self("from", "--pull-never", "localhost/dh-grader"))


def settings_of(dockerfile: str) -> tuple[str, list[str]]:
    """Return the user and the environment variables that a Dockerfile sets."""
    final = dockerfile.rpartition("\nFROM ")[2].replace("\\\n", " ")
    user = re.findall(r"^USER (\S+)", final, re.MULTILINE)[-1]
    pairs = " ".join(re.findall(r"^ENV (.*)", final, re.MULTILINE)).split()
    path = "/usr/local/bin:/usr/bin:/bin"
    return user, [pair.replace('"', "").replace("$PATH", path) for pair in pairs]


def main() -> int:
    dockerfile = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    base = re.findall(r"^FROM ([^\s@]+)", dockerfile, re.MULTILINE)[-1]
    user, environment = settings_of(dockerfile)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        build = Builder(folder)
        build.stand_in(folder / "base", base)
        place = build.image(ROOT)
        added = Path(place, "opt/dh-grader").rglob("*")
        size = sum(file.lstat().st_size for file in added)
        print(f"{size >> 20} MB more than the base image")
        with socket.create_server(("127.0.0.1", 0)) as free:
            variables = [*environment, f"DH_GRADER_PORT={free.getsockname()[1]}"]
        enter = ("unshare", "--mount", "bash", "-c", ENTER, place, user, TRIAL, *variables)
        with (ROOT / "docs/examples/stanford-arm.json").open("rb") as submission:
            done = subprocess.run(
                enter, stdin=submission, stdout=subprocess.PIPE, text=True, check=False
            )
        build("rm", "--all")
        shutil.rmtree(folder / "images", ignore_errors=True)
    return report(done.stdout, user)


def report(seen: str, user: str) -> int:
    uid, *others = seen.splitlines()
    graded = next(json.loads(line) for line in others if line.startswith("{"))
    points = graded["report"]["points"]
    print(f"user {uid}; stanford-arm.json has {points} points")
    for line in (line for line in others if not line.startswith("{")):
        print(line)
    right = uid == user.partition(":")[0] and points == 8.666667
    return 0 if right and others[-2:] == ["health 0", "end 0"] and len(others) == 3 else 1


if __name__ == "__main__":
    sys.exit(main())
