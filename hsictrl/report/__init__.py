"""An assessment on one page that stands alone: HTML with its pictures inside, for screen and print."""

from hsictrl.report.page import report_page

__all__ = ["report_page"]
