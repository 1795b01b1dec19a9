"""Tables, figures and claims of Van Nimmen et al. (2017) as numbers, beside what is printed."""

from hsictrl.paper.recipes import compute, names
from hsictrl.paper.reports import Report

__all__ = ["Report", "compute", "names"]
