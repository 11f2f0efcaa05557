#!/usr/bin/env bash
# Runs the examples and copies their pictures into the book: book/gallery.sh [PERICLES]. Takes a few minutes. Pictures above 200 kB are reduced, which needs python3 with Pillow.
set -euo pipefail
cd "$(dirname "$0")/.."
pericles=${1:-target/release/pericles}
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

# picture EXAMPLE FILE NAME: copies FILE from the pictures of a run of EXAMPLE.
picture() {
    local out="$place/${1//\//-}"
    [ -d "$out" ] || "$pericles" run "examples/$1.toml" --out "$out" --quiet
    local target="book/src/gallery/$3"
    cp "$out/pictures/$2" "$target"
    if [ "$(stat -c %s "$target")" -gt 200000 ]; then
        python3 -c 'import sys; from PIL import Image; picture = Image.open(sys.argv[1]).convert("RGB")
small = picture.resize([3 * n // 4 for n in picture.size], Image.LANCZOS)
palette = small.quantize(255, method=Image.Quantize.MAXCOVERAGE)
small.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(sys.argv[1], optimize=True)' "$target"
    fi
}

picture fracture/mode-one Damage-000003.png mode-one.png
picture fracture/branching Damage-000004.png branching.png
picture fracture/branching-bobaru Damage-000004.png branching-bobaru.png
picture fracture/branching-borden Damage-000004.png branching-borden.png
picture impact/kalthoff-winkler Damage-000003.png kalthoff-winkler.png
picture contact/kalthoff-winkler Damage-000003.png contact-kalthoff-winkler.png
picture contact/ball-through-glass Damage-000003.png ball-through-glass.png
picture contact/two-rings Velocity_x-000002.png two-rings.png
picture contact/dropped-sphere Damage-000003.png dropped-sphere.png
picture contact/closing-crack Displacement_y-000002.png closing-crack.png
picture contact/taylor-bar Velocity_z-000001.png taylor-bar.png
picture fragmentation/cylinder Damage-000002.png cylinder.png
picture impact/block Velocity_x-000002.png block.png
picture multi-time-step/inclusion Velocity_x-000002.png inclusion.png
picture multi-time-step/notched-plate Damage-000002.png notched-plate.png
picture multi-time-step/refined-notch Displacement_y-000002.png refined-notch.png
picture statics/hole Strain_yy-000001.png hole.png
picture points/ring Displacement-000001.png ring.png
picture wave/two-materials Displacement_x-000003.png two-materials.png
picture wave/spectral Displacement_x-000007.png spectral.png
picture wave/plate Velocity_x-000002.png wave-plate.png
picture absorbing/infinite-bar Displacement_x-000001.png infinite-bar.png
picture absorbing/open-plate Velocity_x-000002.png open-plate.png
picture surface/sphere Displacement-000004.png sphere.png
picture surface/torus Strain_Energy_Density-000012.png torus.png
