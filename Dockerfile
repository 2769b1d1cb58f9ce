# The builder ends with /opt/dh-grader: a virtual environment with the program and its catalogue.
# By digest, the same in both stages: python 3.13.15 on Debian trixie. docs/deployment.md says how to
# take a newer one.
FROM python:3.13-slim@sha256:7c61056e61ac89e852de05f3dc6fa51a6dd2181797bceed46aa725dd7cb2cd3b AS builder
ENV PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PIP_NO_CACHE_DIR=1 \
    PIP_ROOT_USER_ACTION=ignore
WORKDIR /src

# Dependencies before the code: these layers are rebuilt only when a lock file changes.
# Without pip of its own, the environment carries nothing that the service does not use.
COPY requirements.lock ./
RUN python -m venv --without-pip /opt/dh-grader \
    && python -m pip --python /opt/dh-grader/bin/python install --require-hashes -r requirements.lock
COPY requirements-build.lock ./
RUN python -m pip install --require-hashes -r requirements-build.lock

COPY pyproject.toml hatch_build.py README.md LICENSE NOTICE ./
COPY exercises exercises
COPY service service
RUN python -m pip wheel --no-deps --no-build-isolation --wheel-dir dist . \
    && python -m pip --python /opt/dh-grader/bin/python install --no-deps --no-index dist/*.whl \
    && /opt/dh-grader/bin/python -m dh_grader.cli.licences > /opt/dh-grader/LICENCES


FROM python:3.13-slim@sha256:7c61056e61ac89e852de05f3dc6fa51a6dd2181797bceed46aa725dd7cb2cd3b
COPY --from=builder /opt/dh-grader /opt/dh-grader
ENV PATH="/opt/dh-grader/bin:$PATH" \
    PYTHONDONTWRITEBYTECODE=1 \
    PYTHONUNBUFFERED=1
WORKDIR /srv
# A new volume that is mounted here belongs to the user of the service.
RUN install --directory --owner=10001 --group=10001 --mode=0700 /data

# By number, so that a cluster which demands a non-root user can see that this is one.
USER 10001:10001
# Inside a container the service must listen on all addresses; which of them reach it, docker decides.
# It needs no keys until there are some.
ENV DH_GRADER_HOST=0.0.0.0 \
    DH_GRADER_OPEN=until-keys \
    DH_GRADER_PORT=8000
EXPOSE 8000

# It asks /healthz at the port that DH_GRADER_PORT names.
HEALTHCHECK --interval=30s --timeout=5s --start-period=5s --retries=3 \
    CMD ["python", "-m", "dh_grader.server.alive"]
CMD ["python", "-m", "dh_grader", "serve"]
