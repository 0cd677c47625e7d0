"""Animation of a crack (GIF): the deformed sheet, coloured by the speed of the material."""
import io

import matplotlib
import numpy as np
from matplotlib import font_manager
from matplotlib.cm import ScalarMappable
from matplotlib.colors import PowerNorm
from matplotlib.ticker import MaxNLocator
from PIL import Image, ImageDraw, ImageFont

from ..folder import write_file
from .pictures import PIXELS_PER_INCH, WIDTH, Page, figure_pixels, limits, save_png
from .raster import Raster

COLOURS = "inferno"
GREYS = 48  # of axes and text, from black to white
SECONDS, LAST_SECONDS = 5.0, 2.0  # duration of all frames except the last, and of the last
LARGEST = 3_000_000  # [bytes]
# Widths [pixels] and numbers of colours, tried in turn until the file is small enough.
SIZES = [(width, shades) for width in (900, 750, 600, 450) for shades in (192, 96, 48)]
LEFT, TOP, FOOT, BAR = 0.85, 0.5, 0.62, 0.75  # margins of the axes and room of the colour bar [in]


def draw_animation(motion, gif, still=None, largest=LARGEST):
    """Writes the animation as GIF of at most `largest` bytes, and its last picture as PNG."""
    times = [frame.time for frame in motion.frames]
    # Uniform slow motion; GIF's unit is 10 ms.
    shown = [max(20, 10 * round(100 * seconds))
             for seconds in [*np.diff(times) / (times[-1] - times[0]) * SECONDS, LAST_SECONDS]]
    film = None
    for width, shades in SIZES:
        if film is None or film.width != width:
            film = Film(motion.frames, motion.mesh, width)
        pictures, data = film.pictures(shades), io.BytesIO()
        pictures[0].save(data, format="GIF", save_all=True, append_images=pictures[1:], duration=shown, loop=0, disposal=1,
                         optimize=False)
        if data.tell() <= largest:
            break
    write_file(str(gif), data.getvalue())
    if still is not None:
        save_png(pictures[-1].convert("RGB"), still)


class Film:
    """Frames of a motion, rasterised at one size."""

    def __init__(self, motion, mesh, width):
        low, high = limits(motion[0].position)
        speeds = [np.linalg.norm(frame.fields["velocity"], axis=1) for frame in motion]
        # Flanks that snap back are much faster than waves; the square root of the speed makes both visible.
        self.scale = PowerNorm(0.5, 0.0, max(np.percentile(speed, 99) for speed in speeds) or 1.0, clip=True)
        inches = WIDTH - LEFT - 0.2
        height = inches * (high - low)[1] / (high - low)[0]
        page = Page(TOP + height + FOOT + BAR)
        axes = page.axes(LEFT, TOP, inches, height)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x [cm]", ylabel="y [cm]")
        axes.grid(False)
        ticks = [tick for tick in MaxNLocator(5).tick_values(0, self.scale.vmax) if tick <= self.scale.vmax]
        page.colour_bar(ScalarMappable(self.scale, COLOURS), LEFT, page.height - 0.7, inches, 0.16, "speed of the material [m/s]",
                        extend="max", ticks=ticks)
        axes = Image.fromarray(figure_pixels(page.figure))
        shrink = width / axes.width
        self.width = width
        self.axes = np.asarray(axes.resize((width, round(shrink * axes.height)), Image.Resampling.LANCZOS)).astype(int)
        left, self.top, right, bottom = (
            round(shrink * PIXELS_PER_INCH * side) for side in (LEFT, TOP, LEFT + inches, TOP + height))
        self.left, self.letters = left, ImageFont.truetype(font_manager.findfont("DejaVu Sans"), round(0.021 * width))
        raster = Raster((low[0], high[0], low[1], high[1]), right - left)
        self.sheets = [(frame.time, raster.draw(mesh, 100 * frame.position, speed, frame.time)[:bottom - self.top])
                       for frame, speed in zip(motion, speeds)]

    def pictures(self, shades):
        """One picture per frame, with a common palette: `shades` colours of the sheet, then greys."""
        colours = np.round(255 * matplotlib.colormaps[COLOURS](np.linspace(0, 1, shades))[:, :3]).astype(int)
        greys = np.repeat(np.round(np.linspace(0, 255, GREYS)).astype(int)[:, None], 3, axis=1)
        palette = np.concatenate((colours, greys)).astype(np.uint8).tobytes()
        axes = shades + np.round(self.axes.mean(axis=2) / 255 * (GREYS - 1)).astype(np.uint8)
        bar = np.ptp(self.axes, axis=2) > 8
        axes[bar] = np.abs(self.axes[bar][:, None] - colours).sum(axis=2).argmin(axis=1)
        made = []
        for time, sheet in self.sheets:
            pixels = axes.copy()
            inside = pixels[self.top:self.top + len(sheet), self.left:self.left + sheet.shape[1]]
            there = ~np.isnan(sheet)
            inside[there] = np.round(self.scale(sheet[there]) * (shades - 1))
            picture = Image.fromarray(pixels, "P")
            picture.putpalette(palette)
            draw = ImageDraw.Draw(picture)
            draw.fontmode = "1"  # without antialiasing
            draw.text((self.left, self.top - 6), f"{1e3 * time:.2f} ms", fill=shades, font=self.letters, anchor="ls")
            made.append(picture)
        return made
