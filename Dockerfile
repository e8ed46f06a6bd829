# blockshake with the locked packages; files of a user are in /work:
#   docker build --tag blockshake .
#   docker run --rm --user "$(id -u):$(id -g)" --volume "$PWD:/work" blockshake study my-study.yaml
FROM python:3.12-slim
WORKDIR /build
COPY requirements.lock ./
RUN python -m pip install --no-cache-dir --require-hashes --requirement requirements.lock
COPY Snakefile LICENSE README.md pyproject.toml setup.py ./
COPY config config
COPY data data
COPY profiles profiles
COPY src src
COPY workflow workflow
RUN python -m pip install --no-cache-dir --no-deps --no-build-isolation . && rm -r /build
# compiled kernels, for a user without a home too
ENV BLOCKSHAKE_CACHE=/var/cache/blockshake
RUN mkdir --mode 1777 /var/cache/blockshake
WORKDIR /work
ENTRYPOINT ["blockshake"]
CMD ["--help"]
