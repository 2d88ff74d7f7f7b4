"""Pictures as files, by the ending of their names."""

from pathlib import Path

from failure import Failure

ENDINGS = (".png", ".svg", ".pdf")


def check_ending(path):
    """Raises Failure before anything is read or drawn for nothing."""
    path = Path(path)
    if path.suffix.lower() not in ENDINGS:
        raise Failure(f"'{path}' ends in none of {', '.join(ENDINGS)}.")
    if not path.resolve().parent.is_dir():
        raise Failure(f"there is no directory '{path.resolve().parent}' for the "
                      f"picture '{path.name}'.")
    return path


def write_picture(figure, path):
    """Nothing in a file depends on when it was written. Raises Failure."""
    from drawing import plt, save

    try:
        if path.suffix.lower() == ".png":
            save(figure, path.parent, path.name)
        else:
            plt.rcParams["svg.hashsalt"] = "friction-plot"
            ending = path.suffix.lower()
            figure.savefig(path, dpi=200, metadata={
                "Date" if ending == ".svg" else "CreationDate": None})
            plt.close(figure)
    except OSError as error:
        raise Failure(f"'{path}' cannot be written: {error.strerror}.") from error
