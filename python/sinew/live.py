"""The live view of a simulation: in the browser, or in a notebook."""

from __future__ import annotations

import time
import webbrowser
from types import TracebackType
from typing import TYPE_CHECKING

from . import _sinew

if TYPE_CHECKING:
    from .simulation import Simulation


class View:
    """A live view that has taken a simulation over: it starts from its state, and its page steps it,
    pulls it and changes it. close() gives the state back.

    Until then whatever would change the simulation raises UsageError: steps, moves of obstacles and
    pins, materials; its arrays keep their values. In a `with` statement the end of the block closes the view. In a notebook a view is
    shown as a frame.
    """

    def __init__(self, simulation: Simulation, *, port: int = 0, framed: bool = False,
                 height: int = 480) -> None:
        self._view = _sinew.View(simulation._s, port, framed)
        self._height = height

    @property
    def url(self) -> str:
        """The address of the page; empty after close()."""
        return self._view.url

    @property
    def is_open(self) -> bool:
        """Whether the view still has the simulation."""
        return self._view.open

    def close(self) -> None:
        """Ends the view; the simulation goes on from the state that it shows, with the same bits if
        nothing was done in the view. Ctrl-C ends the waiting for a long step and leaves it open.

        Raises:
            UsageError: the page shows another scene or material by now. The simulation keeps the
                state that it had before.
        """
        self._view.close()

    def wait(self) -> None:
        """Waits until Ctrl-C, then closes the view: for scripts."""
        try:
            while self.is_open:
                time.sleep(0.2)
        except KeyboardInterrupt:
            self.close()

    def __enter__(self) -> View:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def _repr_html_(self) -> str:
        if not self.is_open:
            return "<p>The view is closed.</p>"
        return (f'<iframe src="{self.url}" width="100%" height="{self._height}" '
                'style="border: 0; border-radius: 8px"></iframe>')


def view(simulation: Simulation, *, port: int = 0, browser: bool = True) -> View:
    """Opens the live view of a simulation in the browser (docs/view.md).

        with sinew.view(sim) as page:
            input("Pull it, then press Enter: ")
        print(sim.time)                    # the simulation goes on from what the page shows

    Args:
        port: 0: any that is free.
        browser: open a browser's window; else only View.url says where the page is.

    Raises:
        UsageError: another view has this simulation.
        IoError: the port is taken.
    """
    page = View(simulation, port=port)
    if browser:
        webbrowser.open(page.url)
    return page
