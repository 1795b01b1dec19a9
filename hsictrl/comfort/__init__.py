"""Load models and comfort classes of Sétra, HiVoSS, ISO 10137 and EN 1990.

Sources: Sétra (2006), Footbridges: assessment of vibrational behaviour; HiVoSS (2008), Design of footbridges:
guideline; ISO 10137 (2007); EN 1990 A2.4.3.2. They were read through public manuals and implementations; a
value that none of these gave is marked "unverified: not checked against the guide" or "the standard".
"""

from hsictrl.comfort.classes import COMFORT_BOUNDS, COMFORT_CLASSES, comfort_class, comfort_verdict
from hsictrl.comfort.guides import (
    GUIDE_LOADS,
    DesignResponse,
    design_acceleration,
    equivalent_pedestrians,
    load_reduction,
)
from hsictrl.comfort.limits import en1990_limit, iso10137_limit

__all__ = [
    "COMFORT_BOUNDS", "COMFORT_CLASSES", "GUIDE_LOADS", "DesignResponse", "comfort_class", "comfort_verdict",
    "design_acceleration", "en1990_limit", "equivalent_pedestrians", "iso10137_limit", "load_reduction",
]
