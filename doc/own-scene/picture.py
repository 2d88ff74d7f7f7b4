"""Draws a run of the scene 'saddle' with ParaView, without its window:

    xvfb-run -a pvpython doc/own-scene/picture.py RUN PICTURE.png

RUN is the output directory. On the left the whole body with displacements ten
times too large and the von Mises stress; on the right one of the two places of
contact, to scale: arrows are the contact stress, their colour is the state.
"""
import sys
from pathlib import Path

import paraview.simple as pv

FACTOR = 10  # of the displacements on the left
LARGEST = 24  # von Mises stress of the scale, N/mm^2
ARROW = 0.03  # lengths of arrows, in millimetres per N/mm^2
PIPE = 20  # the radius, as in the scene; runs do not contain the obstacle
SIZE = 700  # of each of the two views, in pixels
BLACK, WHITE, PALE = (0, 0, 0), (1, 1, 1), (0.82, 0.82, 0.82)
# Open nodes have no stress, hence no arrow.
STATES = {1: ("slides", (0.90, 0.62, 0.0)), 2: ("sticks", WHITE)}


def make_view(centre, half_height, time):
    """A view of the plane, with the given point in its middle."""
    view = pv.CreateView("RenderView")
    view.ViewSize = [SIZE, SIZE]
    view.ViewTime = time
    view.UseColorPaletteForBackground = 0
    view.Background = WHITE
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    view.CameraPosition = [*centre, 100]
    view.CameraFocalPoint = [*centre, 0]
    view.CameraParallelScale = half_height
    return view


def warped(source, factor):
    return pv.WarpByVector(Input=source, Vectors=["POINTS", "displacement"],
                           ScaleFactor=factor)


def paint(display, rgb):
    """One colour, whatever the light."""
    display.ColorArrayName = [None, ""]
    display.AmbientColor = display.DiffuseColor = rgb
    display.Ambient, display.Diffuse = 1, 0


def in_points(source):
    """With the stress as a mean of the cells that meet in a point."""
    return pv.CellDatatoPointData(Input=source)


def colour(display, view, field):
    pv.ColorBy(display, ("POINTS", field))
    display.SetScalarBarVisibility(view, False)
    display.Ambient, display.Diffuse = 1, 0
    return pv.GetColorTransferFunction(field)


def colour_by_stress(display, view):
    """In steps, whose borders are lines of equal stress."""
    colours = colour(display, view, "von_Mises_stress")
    colours.ApplyPreset("Viridis (matplotlib)", True)
    colours.RescaleTransferFunction(0, LARGEST)
    colours.NumberOfTableValues = 24
    return colours


def colour_by_state(display, view):
    colours = colour(display, view, "state")
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = [text for state, (name, _) in STATES.items()
                           for text in (str(state), name)]
    colours.IndexedColors = [part for _, rgb in STATES.values() for part in rgb]
    return colours


def show_scale(colours, view, title):
    bar = pv.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = BLACK
    bar.TitleFontSize = bar.LabelFontSize = 34
    bar.AutomaticLabelFormat, bar.LabelFormat = 0, "%.0f"
    bar.AddRangeLabels, bar.UseCustomLabels = 0, 1
    bar.CustomLabels = [0, LARGEST / 2, LARGEST]
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.6, 28
    bar.Orientation, bar.WindowLocation = "Horizontal", "Any Location"
    bar.Position = [0.2, 0.09]
    bar.Visibility = 1


def show_body(body, view):
    display = pv.Show(warped(in_points(body), FACTOR), view)
    show_scale(colour_by_stress(display, view), view, "von Mises stress")

    # As it was, behind.
    display = pv.Show(body, view)
    paint(display, PALE)
    display.Position = [0, 0, -1]


def show_contact(body, contact, view):
    # Only with the true displacements do body and obstacle fit together.
    display = pv.Show(warped(in_points(body), 1), view)
    colour_by_stress(display, view)

    pipe = pv.Disk(InnerRadius=0, OuterRadius=PIPE,
                   CircumferentialResolution=2000)
    display = pv.Show(pipe, view)
    paint(display, PALE)

    arrows = pv.Glyph(Input=warped(contact, 1), GlyphType="Arrow",
                      OrientationArray=["POINTS", "traction"],
                      ScaleArray=["POINTS", "traction"], ScaleFactor=ARROW,
                      GlyphMode="Every Nth Point", Stride=3)
    arrows.GlyphType.TipRadius = 0.06
    arrows.GlyphType.TipLength = 0.2
    arrows.GlyphType.ShaftRadius = 0.022
    display = pv.Show(arrows, view)
    show_scale(colour_by_state(display, view), view, "contact stress")


def main(run, picture):
    body = pv.PVDReader(FileName=str(run / "body.pvd"))
    contact = pv.PVDReader(FileName=str(run / "contact.pvd"))
    # Levels are times for ParaView, which begins with the first.
    last = body.TimestepValues[-1]
    for source in (body, contact):
        source.UpdatePipeline(last)

    whole = make_view((0, 26), 23, last)
    show_body(body, whole)
    zoom = make_view((-6.6, 18.8), 2.4, last)
    show_contact(body, contact, zoom)

    layout = pv.CreateLayout("picture")
    layout.SplitHorizontal(0, 0.5)
    layout.AssignView(1, whole)
    layout.AssignView(2, zoom)
    layout.SetSize(2 * SIZE, SIZE)
    pv.SaveScreenshot(str(picture), layout, ImageResolution=[2 * SIZE, SIZE],
                      CompressionLevel="9")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: pvpython picture.py RUN PICTURE.png")
    run_directory = Path(sys.argv[1])
    if not (run_directory / "body.pvd").is_file():
        sys.exit(f"picture.py: there is no {run_directory / 'body.pvd'}; run "
                 "the scene first.")
    main(run_directory, Path(sys.argv[2]))
