#!/usr/bin/env bash
# Writes docs/gallery.md, a gallery: each kind of figure with the part of the study that draws it, and what can be set.
# Draws the pictures of the latter into docs/pictures/ from the studies overview and hysteresis (some two minutes on two
# cores); with --page it writes the page alone. All pictures of kinds are those of the studies themselves, taken from the folders
# of their results where those are there.
set -euo pipefail
cd "$(dirname "$0")/.."

program=target/release/capsulemap
page=docs/gallery.md

# The lines of a study that ask for a figure: study, name of the figure.
asked() {
    awk -v name="$2" '
        /^\[\[figures\]\]/ { if (found) exit; block = "" }
        /^\[/ && !/^\[\[figures\]\]/ { if (found) exit; block = ""; inside = 0; next }
        /^\[\[figures\]\]/ { inside = 1 }
        inside { block = block $0 "\n" }
        inside && $0 == "name = \"" name "\"" { found = 1 }
        END { if (found) { sub(/\n+$/, "", block); print block } }
    ' "studies/$1.toml"
}

# A kind of figure: kind, what it shows, study, name of the figure, picture.
kind() {
    printf '## %s\n\n%s\n\n![%s](pictures/%s)\n\n[studies/%s.toml](../studies/%s.toml):\n\n```toml\n%s\n```\n\n' \
        "$1" "$2" "$1" "$5" "$3" "$3" "$(asked "$3" "$4")"
}

# A figure from a file of results with what is set of it: heading, what it shows, name, options.
setting() {
    local heading=$1 words=$2 name=$3
    shift 3
    local shown=""
    for option in "$@"; do
        case $option in
        *[!A-Za-z0-9_./,=-]*) shown+=" '$option'" ;;
        *) shown+=" $option" ;;
        esac
    done
    printf '### %s\n\n%s\n\n![%s](pictures/%s.png)\n\n```sh\ncapsulemap figure%s\n```\n\n' \
        "$heading" "$words" "$heading" "$name" "$shown"
    if [ "$draw" = yes ]; then
        "$program" figure "$@" --name "$name" --folder docs/pictures --formats png --overwrite >&2
    fi
}

draw=yes
if [ "${1:-}" = --page ]; then
    draw=no
else
    scripts/setup.sh
    cargo build --release
    for study in overview hysteresis fig6; do
        "$program" sweep "studies/$study.toml" --no-figures
    done
    # Its diagram shows the branches, too.
    "$program" continue studies/hysteresis.toml
    # Runs draw into folders that git ignores.
    for picture in docs/pictures/*/*.png; do
        drawn=results/${picture#docs/pictures/}
        [ ! -f "$drawn" ] || cp "$drawn" "$picture"
    done
fi

{
    printf '# Gallery\n\nEach kind of figure with the part of the study that draws it; `scripts/gallery.sh` makes this page. '
    printf 'A figure is drawn from the file of results alone, by `capsulemap figure FILE.h5`, and again with other settings.\n\n'
    kind bifurcation "Outputs over an axis: each attractor in its colour, the branches of continued orbits as lines, special points as symbols." \
        hysteresis bifurcation hysteresis/bifurcation.png
    kind map "An output, the period or the outcome over two axes; several panels over the values of a third and a fourth." \
        plane speed plane/speed.png
    kind basin "Which attractor each start leads to." three-ways basin three-ways/basin.png
    kind "basin, with its boundary as curves" "The stable manifolds of the saddle between two basins, and its unstable ones." \
        manifolds manifolds manifolds/manifolds.png
    kind settling "For how many cycles each start is followed until its attractor is decided." fractal settling fractal/settling.png
    kind shares "Shares of the starts that lead to each attractor along a parameter, and the integrity factor of each basin." \
        erosion shares erosion/shares.png
    kind section "The stroboscopic section points of a motion, and its impacts." chaos section chaos/section.png
    kind history "Displacements, velocities and forces over time." fig6 fig6 paper/fig6.png
    kind phase-portrait "One coordinate over another, for one case or several." fig6 fig6-phase-portrait paper/fig6-phase-portrait.png
    kind spectrum "Amplitudes of a history over frequency." fig6 fig6-spectrum paper/fig6-spectrum.png
    kind curves "Special points of branches as curves in two parameters." regions curves regions/curves.png
    kind "map, with what bounds its regions" "Where motions begin, end or change, as curves that are followed from neighbours which differ." \
        boundaries regions boundaries/regions.png
    kind "bifurcation, along a path" "Outputs while two parameters rise together." path diagram path/diagram.png
    kind trade-off "Speed against what it costs, with the Pareto fronts and the optima of both directions." \
        best best-trade-off paper/best-trade-off.png
    kind trade-off-maps "The fastest motion of each cell over two axes, what it costs, and where the fronts lie." \
        best best-maps paper/best-maps.png
    kind sensitivity "Sobol indices: which of the quantities that are drawn the variance of outputs comes from." \
        sensitivity sensitivity sensitivity/sensitivity.png
    printf '## What can be set\n\nThe same options are keys of `[[figures]]` in a study; [the study file](study/figures.md) lists them.\n\n'
    setting "Limits, units, colours, contours and words" "Speeds beyond the limits have the colour of their end, and the bar says so by an arrow." \
        limits results/overview/overview.h5 --kind map --of progression_speed --x omega --y p_d \
        --limits "progression_speed=-5 mm/s,10 mm/s" --unit omega=Hz --contours progression_speed=0 \
        --colour-map progression_speed=purple-orange --width "86 mm" --height "65 mm" \
        --text "forward: omega=92, p_d=2.7" --text "backward: omega=64, p_d=3.2" --text "at rest: omega=45, p_d=2"
    setting "Colours by another quantity" "Points have the colours of their periods, and frequencies are relative to the natural one." \
        periods results/hysteresis/hysteresis.h5 --kind bifurcation --of section_r,progression_speed --colour-by period \
        --unit "omega=sqrt(k1/m1)" --marker-size "0.4 mm"
    setting "Symmetric logarithmic scales" "Speeds of both signs over five decades; linear within 0.01 mm/s of zero." \
        symlog results/overview/overview.h5 --kind map --of progression_speed --x omega --y p_d \
        --scale "progression_speed=symlog 0.01 mm/s" --title "Progression for "'$k_2$ = 86.8 kN/m'
    setting "Forces over time" "What follows from the stored motion can be shown, too." \
        forces results/fig6/fig6.h5 --kind history --of history_x1,history_contact,history_friction
} >"$page"
