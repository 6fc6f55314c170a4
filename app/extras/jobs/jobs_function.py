"""Jobs in the list of special functions, F10: what is under way, what is next, and the way to the page."""

from __future__ import annotations

from app.desk.pages.sheet import Row
from app.desk.status.formats import NOTHING
from app.desk.translation import tr
from app.extras.jobs.jobs_watch import JobsWatch
from app.special.special_functions import PageFunction

PAGE = "JOBS"  # its name in app.screen.page_table


class JobsFunction(PageFunction):
    """How many jobs wait, and which is next."""

    name = "JOBS"
    use = "next job, number of parts, setup requirements"
    page = PAGE
    way = (
        "Press Enter to open the JOBS page. Shift+F6 opens it from any page, and J opens it "
        "from the main menu."
    )

    def facts(self) -> tuple[Row, ...]:
        """Under way, next, waiting."""
        watch = self.desk.attached(JobsWatch)
        if watch is None:
            return ()
        job, coming = watch.under_way, watch.next
        made = f"{job.program}  {job.made}/{job.wanted}" if job is not None else NOTHING
        then = f"{coming.program}  {coming.left}" if coming is not None else NOTHING
        waiting = sum(not each.done and not each.under_way for each in watch.jobs)
        return (Row((tr("IN PROGRESS"), made)), Row((tr("NEXT"), then)), Row((tr("WAITING"), str(waiting))))

    def prompt(self) -> str:
        """How the page is opened."""
        return "ENTER: OPEN JOBS   ESC: BACK TO THE LIST"
