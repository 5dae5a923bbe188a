"""stub"""
from typing import Literal
MetalName = Literal["gold", "silver", "copper", "aluminium", "iron"]
METALS = {"gold": ((0.143,0.375,1.442),(3.983,2.386,1.603)), "silver": ((0.155,0.117,0.138),(4.822,3.122,2.147)), "copper": ((0.200,0.924,1.102),(3.912,2.453,2.142)), "aluminium": ((1.657,0.880,0.521),(9.224,6.270,4.837)), "iron": ((2.9,2.95,2.6),(3.1,2.95,2.8))}
