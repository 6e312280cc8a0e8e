#!/usr/bin/env bash
# Installs the programs that compare.py compares with, outside of the repository.
#
#     benches/peers/setup.sh [DIR]        (default: ${XDG_CACHE_HOME:-~/.cache}/asperity-peers)
#
# By pip, in a virtual environment: tamaas, ContactMechanics, reynoldsflow, aspher, numpy, scipy. aspher comes as
# source: it is built here, for any machine and for this one (-march=native), with the header-only Eigen of the
# distribution, unpacked, not installed. By apt: FFTW, both as it is packaged (3.3.10 on Debian 12), and built from the
# same source with AVX2 and, where the processor has it, AVX-512, which the package lacks. All from where this machine's
# pip and apt are told to take it.
# Needs python3 with venv, gcc, g++, make and, on Debian or Ubuntu, apt-get; no root. Takes some ten minutes.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
dir=${1:-${XDG_CACHE_HOME:-$HOME/.cache}/asperity-peers}
mkdir -p "$dir"
dir=$(cd "$dir" && pwd)
cd "$dir"

echo "== packages of the distribution, unpacked in $dir/debian"
mkdir -p debian
(
    cd debian
    apt-get download libeigen3-dev libfftw3-double3 libfftw3-single3
    for package in *.deb; do dpkg-deb -x "$package" .; done
)
eigen=$dir/debian/usr/share/eigen3/cmake
libraries=$(dirname "$(find "$dir/debian" -name libfftw3.so.3)")

echo "== FFTW from the distribution's source, for this processor, in $dir/fftw"
if [ ! -e fftw/lib/libfftw3f.so.3 ]; then
    mkdir -p source/lists/partial source/cache/archives/partial
    cd source
    # where the packages of this machine's own distribution come from, the source of one is found, too
    codename=$(. /etc/os-release && echo "$VERSION_CODENAME")
    apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' \
        "Codename: $codename" | sort -u > sources.list
    apt=(apt-get -o "Dir::Etc::sourcelist=$PWD/sources.list" -o Dir::Etc::sourceparts=- -o "Dir::State::lists=$PWD/lists"
        -o "Dir::Cache=$PWD/cache")
    "${apt[@]}" update
    "${apt[@]}" source --download-only fftw3
    mkdir -p fftw
    tar xzf fftw3_*.orig.tar.gz -C fftw --strip-components=1
    vectors=(--enable-sse2 --enable-avx)
    ! grep -qw avx2 /proc/cpuinfo || vectors+=(--enable-avx2)
    ! grep -qw avx512f /proc/cpuinfo || vectors+=(--enable-avx512)
    for precision in double single; do
        mkdir -p "$precision"
        (
            cd "$precision"
            ../fftw/configure "--enable-$precision" "${vectors[@]}" --enable-shared --disable-static --disable-fortran \
                --disable-doc --prefix="$dir/fftw" CFLAGS="-O3 -march=native -fomit-frame-pointer" > configure.log
            make -j"$(nproc)" > make.log 2>&1
            make install > install.log
        )
    done
    cd ..
fi

gcc -O3 -march=native -o fftw64 "$here/fftw.c" -lm -ldl
gcc -O3 -march=native -DREAL=float -o fftw32 "$here/fftw.c" -lm -ldl

echo "== Python, in $dir/venv"
[ -e venv ] || python3 -m venv venv
venv/bin/pip install --quiet numpy==2.4.6 scipy==1.17.1 tamaas==2.9.0 ContactMechanics==1.8.3 \
    reynoldsflow==0.1.3 pyamg==5.4.1 pypardiso==0.4.7
# as pip builds it, and for this machine; each is the faster in one of the two precisions
for build in portable:OFF native:ON; do
    rm -rf "aspher-${build%:*}"
    venv/bin/pip install --quiet --no-deps --no-cache-dir --target "aspher-${build%:*}" aspher==0.1.3.post1 \
        --config-settings=cmake.define.Eigen3_DIR="$eigen" --config-settings=cmake.define.ASPHER_NATIVE="${build#*:}"
    PYTHONPATH="aspher-${build%:*}" venv/bin/python -c 'import aspher'
done
venv/bin/python -c 'import numpy, scipy, tamaas, ContactMechanics, reynoldsflow'

{
    printf '%s\n' "$libraries/libfftw3.so.3" "$dir/fftw/lib/libfftw3.so.3"
} > fftw64.libraries
{
    printf '%s\n' "$libraries/libfftw3f.so.3" "$dir/fftw/lib/libfftw3f.so.3"
} > fftw32.libraries
echo "ready: benches/peers/compare.py --peers $dir"
