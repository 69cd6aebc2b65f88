# aolab on Debian 13 with the versions of tools/pinned.txt, with JupyterLab, as a user without rights. No GPU is needed.
#
#   docker build -t aolab .
#   docker run --rm -p 127.0.0.1:8888:8888 aolab                                    # JupyterLab; open the printed address
#   docker run --rm --network none -v "$PWD:/work" -w /work aolab aolab exercise grade submissions/* -o grades.csv
#
# Binder builds this file, too: it chooses NB_USER and NB_UID.
FROM debian:13-slim

RUN apt-get update \
    && apt-get install --yes --no-install-recommends python3 python3-venv libegl1 libgl1 libgl1-mesa-dri \
    && rm -rf /var/lib/apt/lists/*

COPY . /opt/aolab
RUN python3 -m venv /opt/venv \
    && /opt/venv/bin/pip install --no-cache-dir --constraint /opt/aolab/tools/pinned.txt "/opt/aolab[notebook,sweep]" notebook

ARG NB_USER=student
ARG NB_UID=1000
ENV HOME=/home/${NB_USER} PATH=/opt/venv/bin:${PATH}
RUN useradd --uid ${NB_UID} --create-home ${NB_USER} \
    && cp -r /opt/aolab/examples ${HOME}/examples \
    && chown -R ${NB_UID} ${HOME}
WORKDIR ${HOME}
USER ${NB_USER}

CMD ["jupyter", "lab", "--ip=0.0.0.0", "--no-browser"]
