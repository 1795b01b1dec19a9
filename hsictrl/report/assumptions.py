"""What an assessment takes for granted, in short; `docs/choices.md` says more."""

from __future__ import annotations

from hsictrl.assessment import Assessment


def assumptions(found: Assessment) -> list[str]:
    """Those that apply."""
    return [
        "MF: forces move over the empty bridge. PMC: forces move over the bridge on which a crowd stands, so that its "
        "bodies take part in the vibration; as many bodies as people on average, anywhere on the deck with the same "
        "chance, anew in each trial. Both models meet the same people.",
        *_steps(found),
        "Arrivals are a Poisson process; everybody walks straight on, at the speed that goes with the density unless "
        "a speed is given.",
        "The deck fills for one crossing time T, then max(T, 5/(ξω)) passes by the model's own damping; peaks are "
        "those of one further crossing.",
        f"Each walker weighs {found.flow.weight:g} N, which drives; the body of the population moves.",
        "Accelerations are vertical. All modes respond; only one is brought into resonance.",
        "Effective damping is 1/(2 m max|H|) with the modal mass of the empty bridge (eq. 17), so that added mass "
        "counts as damping.",
        "The interval of a percentile is distribution-free, from order statistics; those of R_HSI join the ends of two "
        "intervals. A goal is met or not met if the whole interval lies on one side of its bound, otherwise undecided.",
        "Guides: n′ = 10.8 √(ξ n)/S below 1 person/m² and 1.85 √n/S from there on; a = P ψ n′ ∫∫|φ| dx dy/(2 ξ m) with "
        "P = 280 N vertical and 35 N lateral, the shape being one where it moves the most in the direction of the "
        "load. A crowd of 70 kg each is added where it is more than 5 % of the modal mass. Constants were read "
        "through public manuals and implementations of the guides; the lateral load rests on one source, and the "
        "lateral bound of 0.3 m/s² is not checked against the guide.",
        f"Trial i draws from numpy's SeedSequence({found.pmc.seed}, spawn_key=(i,)).",
        "Models and load case: Van Nimmen, Lombaert, De Roeck and Van den Broeck (2017).",
    ]


def _steps(found: Assessment) -> list[str]:
    if found.flow.step_frequency is not None:
        return [f"Step frequencies are set by hand: {found.flow.step_frequency} Hz (mean, standard deviation)."]
    empty = "effective frequency of the bridge with its absorbers" if found.bridge.absorbers else (
        "frequency of the empty bridge")
    return ["Steps are tuned to resonance, the design load case: their mean is f/h with the smallest harmonic h for "
            f"which it is at most 2.5 Hz, where f is the {empty} for MF, and the effective one of "
            "each trial's crowd for PMC. Below 1 person/m² they scatter by 0.175 Hz; from there on all are equal."]
