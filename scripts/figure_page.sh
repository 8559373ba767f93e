#!/usr/bin/env bash
# Sets six figures, each as wide as a column of a journal (86 mm), on a page of two columns: results/page.pdf.
# It shows how figures of different kinds stand beside each other in a paper: the same fonts, line widths and frames.
# Needs the results of the studies below, which it computes if they are not there (some five minutes on two cores), and
# Python, for which it installs pypdf into target/figure-page.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
cargo build --release
program=target/release/capsulemap
work=target/figure-page
mkdir -p "$work"

results() {
    [ -e "results/$1/$1.h5" ] || "$program" sweep "studies/$1.toml" --no-figures
}
for study in overview hysteresis fig6 three-ways; do
    results "$study"
done

figure() {
    local study=$1
    shift
    "$program" figure "results/$study/$study.h5" "$@" --width "86 mm" --folder "$work" --formats pdf --overwrite
}
figure fig6 --kind history --of history_r,history_contact,history_friction --cycles 0,2 --height "78 mm" --name a
figure fig6 --kind phase-portrait --height "78 mm" --name b
figure hysteresis --kind bifurcation --of section_r,progression_speed --height "86 mm" --name c
figure overview --kind trade-off --of power --height "86 mm" --name d
figure overview --kind map --of progression_speed --x omega --y p_d --scale "progression_speed=symlog 0.01 mm/s" \
    --height "72 mm" --name e
figure three-ways --kind basin --height "72 mm" --name f

[ -x "$work/python/bin/python" ] || python3 -m venv "$work/python"
"$work/python/bin/pip" install --quiet --disable-pip-version-check pypdf==7.1.0
"$work/python/bin/python" - "$work" results/page.pdf <<'PYTHON'
import sys

from pypdf import PageObject, PdfReader, PdfWriter

work, page_path = sys.argv[1:]
mm = 72 / 25.4
width, height, margin, gutter, gap = 210 * mm, 297 * mm, 16 * mm, 6 * mm, 5 * mm
page = PageObject.create_blank_page(width=width, height=height)
for column, names in enumerate(("ace", "bdf")):
    top = height - margin
    for name in names:
        figure = PdfReader(f"{work}/{name}.pdf").pages[0]
        top -= float(figure.mediabox.height)
        page.merge_translated_page(figure, margin + column * (86 * mm + gutter), top)
        top -= gap
writer = PdfWriter()
writer.add_page(page)
writer.write(page_path)
PYTHON
echo results/page.pdf
