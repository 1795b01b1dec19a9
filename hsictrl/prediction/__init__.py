"""Recipes that predict the response to traffic; they differ where the paper's Table 1 says they differ."""

from hsictrl.prediction.assumptions import ASSUMPTIONS, Assumptions
from hsictrl.prediction.models import MODELS, Prediction, predict, predict_tuned, tune

__all__ = ["ASSUMPTIONS", "MODELS", "Assumptions", "Prediction", "predict", "predict_tuned", "tune"]
