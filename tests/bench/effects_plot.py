"""effects_plot.py: the rows of effects.py as a picture: difference and its interval, in units of the scatter of seeds."""
import html

ROW, LEFT, WIDTH, REACH = 18, 400, 460, 3.0  # px, px, px, standard deviations to each side


def plot(rows, feature):
    """SVG text. Grey: one standard deviation of seeds; bar: 99 % interval of the mean difference."""
    height = ROW * (len(rows) + 4)
    middle, scale = LEFT + WIDTH / 2, WIDTH / (2 * REACH)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 20}" height="{height}" '
           'font-family="sans-serif" font-size="12">', '<rect width="100%" height="100%" fill="white"/>',
           f'<text x="10" y="{ROW}" font-weight="bold">{feature}: mean difference and its 99 % interval, in standard '
           'deviations of the seeds</text>',
           f'<rect x="{middle - scale:.1f}" y="{1.5 * ROW}" width="{2 * scale:.1f}" height="{ROW * len(rows) + 6}" '
           'fill="#e8e8e8"/>']

    def place(value):
        return middle + scale * max(-REACH, min(REACH, value))

    for k, row in enumerate(rows):
        y = ROW * (k + 2) + 4
        colour = "#c03020" if row["verdict"] == "differs" else "#205080"
        out.append(f'<text x="10" y="{y + 4}">{html.escape(row["scene"])}: {html.escape(row["figure"])}</text>')
        if row["sd_off"] > 0:
            centre, half = row["difference"] / row["sd_off"], row["limit"] / row["sd_off"]
            out.append(f'<line x1="{place(centre - half):.1f}" x2="{place(centre + half):.1f}" y1="{y}" y2="{y}" '
                       f'stroke="{colour}" stroke-width="2"/>')
            out.append(f'<circle cx="{place(centre):.1f}" cy="{y}" r="4" fill="{colour}"/>')
    bottom = ROW * (len(rows) + 2)
    for tick in range(-int(REACH), int(REACH) + 1):
        out.append(f'<line x1="{place(tick):.1f}" x2="{place(tick):.1f}" y1="{1.5 * ROW}" y2="{bottom}" stroke="#b0b0b0" '
                   f'stroke-width="{1 if tick else 2}"/>')
        out.append(f'<text x="{place(tick):.1f}" y="{bottom + ROW}" text-anchor="middle">{tick}</text>')
    return "\n".join([*out, "</svg>"]) + "\n"
