"""
Figure 2: five models of the same people
========================================

From forces in fixed places (SF) to bodies that walk (MC): the models differ in whether forces move, and in what stands
for the bodies. Table 1 of the paper says how.

**What differs.** Each panel is drawn by its row of table 1 from one traffic of four walkers, so it shows what the model
computes with, 38 s after the first of them stepped on. Places along the deck are to scale.
"""

from hsictrl.paper import compute

figure = compute("fig2")
figure.draw()

# %%
# Table 1 beside it. Order and type stand in the paper's table 2; here they are also found on the systems themselves,
# by linearising them at two instants.

for row in compute("table1").rows:
    kind = "time-variant" if row["time_variant_found"] else "time-invariant"
    print(f"{row['model']:4}  forces {row['fixed_driver']}, interaction: {row['interaction']}")
    print(f"      n_s = {row['order']} = {row['order_found']} for {row['persons_on_deck']} persons, {kind}")
