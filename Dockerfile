# The builder ends with /opt/dh-grader: a virtual environment with the program and its catalogue.
FROM python:3.13-slim AS builder
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

COPY pyproject.toml README.md LICENSE ./
COPY exercises exercises
COPY service service
RUN python -m pip wheel --no-deps --no-build-isolation --wheel-dir dist . \
    && python -m pip --python /opt/dh-grader/bin/python install --no-deps --no-index dist/*.whl


FROM python:3.13-slim
COPY --from=builder /opt/dh-grader /opt/dh-grader
ENV PATH="/opt/dh-grader/bin:$PATH" \
    PYTHONDONTWRITEBYTECODE=1 \
    PYTHONUNBUFFERED=1
WORKDIR /srv

# By number, so that a cluster which demands a non-root user can see that this is one.
USER 10001:10001
EXPOSE 8000

# http.client rather than urllib: a proxy in the environment must not be asked about 127.0.0.1.
HEALTHCHECK --interval=30s --timeout=5s --start-period=5s --retries=3 \
    CMD ["python", "-c", "from http.client import HTTPConnection as C; c = C('127.0.0.1', 8000, timeout=3); c.request('GET', '/healthz'); raise SystemExit(c.getresponse().status != 200)"]
CMD ["python", "-m", "service", "serve", "--host", "0.0.0.0"]
