#!/bin/sh
# Makes the wheel, module and command, in python/wheels. Needs maturin: `pip install maturin`.
set -eu
cd "$(dirname "$0")"
profile=${1:-release}
cargo build --locked --manifest-path ../Cargo.toml --package checkdam-cli --profile "$profile"
folder=$profile
if [ "$folder" = dev ]; then folder=debug; fi
mkdir -p checkdam.data/scripts
cp "../target/$folder/checkdam" checkdam.data/scripts/checkdam
rm -f wheels/*.whl
maturin build --locked --profile "$profile" --out wheels
