<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="es" sourcelanguage="en">
  <context>
    <name>turndesk</name>
    <message>
      <location filename="" />
      <source>%1 COMES ON</source>
      <translation>SE ENCIENDE %1</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 GOES OFF</source>
      <translation>SE APAGA %1</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 HAS COME ON AND %2</source>
      <translation>SE ENCENDIÓ %1 Y %2</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 HAS GONE OFF AND %2</source>
      <translation>SE APAGÓ %1 Y %2</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 cannot run while nose compensation is active.</source>
      <translation>%1 no puede correr con la compensación de punta activa.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 cuts a contour, and its lines would have to follow</source>
      <translation>%1 corta un contorno, y sus líneas tendrían que seguir</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 has no feed: none for cutting is in force.</source>
      <translation>%1 no tiene avance: no hay ninguno de corte vigente.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 is no surface speed that a tool can stand.</source>
      <translation>%1 no es velocidad superficial que aguante una herramienta.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 is the first move after the T on line %2: its start point is not known.</source>
      <translation>%1 es el primer movimiento tras la T de la línea %2: no se conoce su punto de inicio.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 makes a corner at the end of a straight move, and the line has none.</source>
      <translation>%1 hace una esquina al final de una recta, y la línea no tiene ninguna.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 needs %2 of the corner opposite to the start point.</source>
      <translation>%1 necesita %2 de la esquina opuesta al punto de inicio.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 needs %2, %3.</source>
      <translation>%1 necesita %2, %3.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 needs Z, the bottom of the hole.</source>
      <translation>%1 necesita Z, el fondo del barreno.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 needs a C axis, and the machine file switches it off.</source>
      <translation>%1 necesita un eje C, y el archivo de máquina lo apaga.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 turns the spindle, which is not locked.</source>
      <translation>%1 gira el husillo, que no está bloqueado.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1 · SIMULATED</source>
      <translation>%1 · SIMULADO</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: %2 stands without a number here.</source>
      <translation>%1: aquí %2 está sin número.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: %2, %3, must be over 0.</source>
      <translation>%1: %2, %3, debe ser mayor que 0.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: C turns at more than 0 and at most %2 rpm.</source>
      <translation>%1: C gira a más de 0 y a lo más %2 rpm.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: U is what the cycle leaves on a side, which is never negative.</source>
      <translation>%1: U es lo que el ciclo deja por lado, y nunca es negativo.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: a corner's size must be a number over 0.</source>
      <translation>%1: el tamaño de una esquina debe ser mayor que 0.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: beside G35 only F2 has a meaning (leads to 2 in/rev).</source>
      <translation>%1: junto a G35 sólo F2 tiene sentido (pasos hasta 2 pulg/rev).</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: the angle of infeed goes from 0 to 30 degrees.</source>
      <translation>%1: el ángulo de entrada va de 0 a 30 grados.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: the lead must be above 0 and at most %2.</source>
      <translation>%1: el paso debe ser mayor que 0 y a lo más %2.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: the rate of the retract goes from over 0 to %2.</source>
      <translation>%1: la velocidad de retiro va de más de 0 a %2.</translation>
    </message>
    <message>
      <location filename="" />
      <source>%1: the speed has no sign; M03 and M04 say the direction.</source>
      <translation>%1: la velocidad no lleva signo; M03 y M04 dicen el sentido.</translation>
    </message>
    <message>
      <location filename="" />
      <source>(~%1) turns C, which is not locked.</source>
      <translation>(~%1) gira C, que no está bloqueado.</translation>
    </message>
    <message>
      <location filename="" />
      <source>(~%1) under G95: a plane is fed in inches a minute.</source>
      <translation>(~%1) con G95: un plano avanza en pulgadas por minuto.</translation>
    </message>
    <message>
      <location filename="" />
      <source>(~%1) with nose compensation on.</source>
      <translation>(~%1) con compensación de punta activa.</translation>
    </message>
    <message>
      <location filename="" />
      <source>A T stands between G35 and G36.</source>
      <translation>Hay una T entre G35 y G36.</translation>
    </message>
    <message>
      <location filename="" />
      <source>A dwell of %1 s is out of range: 0.1 s to an hour.</source>
      <translation>Una espera de %1 s está fuera de rango: de 0.1 s a una hora.</translation>
    </message>
    <message>
      <location filename="" />
      <source>AN I/O MODULE DOES NOT ANSWER</source>
      <translation>UN MÓDULO DE E/S NO RESPONDE</translation>
    </message>
    <message>
      <location filename="" />
      <source>AND %1 MORE</source>
      <translation>Y %1 MÁS</translation>
    </message>
    <message>
      <location filename="" />
      <source>Add R, or I and K.</source>
      <translation>Agregue R, o I y K.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Arcs cannot be incremental in diameter mode.</source>
      <translation>Los arcos no pueden ser incrementales en modo diámetro.</translation>
    </message>
    <message>
      <location filename="" />
      <source>C MOVES WHILE THE SPINDLE TURNS</source>
      <translation>C SE MUEVE MIENTRAS EL HUSILLO GIRA</translation>
    </message>
    <message>
      <location filename="" />
      <source>Close it with M12 first.</source>
      <translation>Ciérrela primero con M12.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Correct %1.</source>
      <translation>Corrija %1.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Correct C; bare C is 29 degrees.</source>
      <translation>Corrija C; C sola es 29 grados.</translation>
    </message>
    <message>
      <location filename="" />
      <source>E-STOP AT THE CONTROLLER</source>
      <translation>PARO DE EMERGENCIA EN EL CONTROLADOR</translation>
    </message>
    <message>
      <location filename="" />
      <source>End G%1 first: a move off the part, then G40.</source>
      <translation>Termine primero G%1: un movimiento fuera de la pieza, luego G40.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Feed %1 is out of range: %2 to %3.</source>
      <translation>El avance %1 está fuera de rango: de %2 a %3.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G%1 comes while G%2 is on.</source>
      <translation>G%1 viene con G%2 activo.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G%1 does not stand alone on its line.</source>
      <translation>G%1 no va sola en su línea.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G%1 is active, and a thread is cut without nose compensation.</source>
      <translation>G%1 está activo, y una rosca se corta sin compensación de punta.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G%1 needs S, a speed in rpm.</source>
      <translation>G%1 necesita S, una velocidad en rpm.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G%1 needs X or Z.</source>
      <translation>G%1 necesita X o Z.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G%1 stands alone on its line.</source>
      <translation>G%1 va sola en su línea.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G00 stands with F, G94 or G95, each of which ends the rapid.</source>
      <translation>G00 está con F, G94 o G95, y cada uno termina el rápido.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G01 goes back to the last cutting feed, and none has been set after the first line.</source>
      <translation>G01 vuelve al último avance de corte, y no se puso ninguno después de la primera línea.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G04 does not say how long.</source>
      <translation>G04 no dice cuánto.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G35 is in force already.</source>
      <translation>G35 ya está vigente.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G89 locks the spindle and stands without M codes.</source>
      <translation>G89 bloquea el husillo y va sin códigos M.</translation>
    </message>
    <message>
      <location filename="" />
      <source>G96 is active, and a thread needs one speed from first pass to last.</source>
      <translation>G96 está activo, y una rosca necesita una sola velocidad de la primera a la última pasada.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Give larger arcs I and K.</source>
      <translation>A los arcos mayores déles I y K.</translation>
    </message>
    <message>
      <location filename="" />
      <source>I is missing.</source>
      <translation>Falta I.</translation>
    </message>
    <message>
      <location filename="" />
      <source>I, the depth of the first pass, must be above 0.</source>
      <translation>I, la profundidad de la primera pasada, debe ser mayor que 0.</translation>
    </message>
    <message>
      <location filename="" />
      <source>IN/OUT</source>
      <translation>INT/EXT</translation>
    </message>
    <message>
      <location filename="" />
      <source>K, the lead, is missing.</source>
      <translation>Falta K, el paso.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Keep one way.</source>
      <translation>Deje una sola forma.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Line %1 begins in the work, and no sure way leads there.</source>
      <translation>La línea %1 empieza dentro de la pieza y ningún camino seguro lleva allí.</translation>
    </message>
    <message>
      <location filename="" />
      <source>M%1 starts the spindle and no S has said how fast.</source>
      <translation>M%1 arranca el husillo y ninguna S dijo qué tan rápido.</translation>
    </message>
    <message>
      <location filename="" />
      <source>M%1 starts the spindle with the collet open.</source>
      <translation>M%1 arranca el husillo con la boquilla abierta.</translation>
    </message>
    <message>
      <location filename="" />
      <source>M%1 starts the spindle, which is locked as the axis C.</source>
      <translation>M%1 arranca el husillo, que está bloqueado como eje C.</translation>
    </message>
    <message>
      <location filename="" />
      <source>M03 FWD</source>
      <translation>M03 ADEL</translation>
    </message>
    <message>
      <location filename="" />
      <source>M04 REV</source>
      <translation>M04 REV</translation>
    </message>
    <message>
      <location filename="" />
      <source>M05 OFF</source>
      <translation>M05 ALTO</translation>
    </message>
    <message>
      <location filename="" />
      <source>M13 opens the collet while the spindle turns.</source>
      <translation>M13 abre la boquilla con el husillo girando.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Move there before the plane.</source>
      <translation>Muévase ahí antes del plano.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Move to X and Z of the start point before it.</source>
      <translation>Muévase antes a la X y la Z del punto de inicio.</translation>
    </message>
    <message>
      <location filename="" />
      <source>No G35 is in force that G36 could end.</source>
      <translation>No hay G35 vigente que G36 pueda terminar.</translation>
    </message>
    <message>
      <location filename="" />
      <source>P does not say which subroutine describes the contour.</source>
      <translation>P no dice qué subrutina describe el contorno.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Put G40 and a departure before it.</source>
      <translation>Ponga antes G40 y una salida.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Put it on the line with X or Z.</source>
      <translation>Póngalo en la línea con X o Z.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Put the rest on a line of its own.</source>
      <translation>Ponga lo demás en su propia línea.</translation>
    </message>
    <message>
      <location filename="" />
      <source>R must be a number over 0.</source>
      <translation>R debe ser un número mayor que 0.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Release it with M05 first.</source>
      <translation>Libérelo primero con M05.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Set axis.C.enabled.</source>
      <translation>Ponga axis.C.enabled.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Set one with G95Fn or G94Fn.</source>
      <translation>Ponga uno con G95Fn o G94Fn.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Stop it with M05 first.</source>
      <translation>Párelo primero con M05.</translation>
    </message>
    <message>
      <location filename="" />
      <source>THE PROGRAM ENDS WITHOUT M30 OR M02</source>
      <translation>EL PROGRAMA TERMINA SIN M30 NI M02</translation>
    </message>
    <message>
      <location filename="" />
      <source>THE SPINDLE DOES NOT BECOME C</source>
      <translation>EL HUSILLO NO PASA A SER C</translation>
    </message>
    <message>
      <location filename="" />
      <source>Take the line out.</source>
      <translation>Quite la línea.</translation>
    </message>
    <message>
      <location filename="" />
      <source>The T on line %1 has not been moved to X and Z.</source>
      <translation>La T de la línea %1 no se ha movido a X y Z.</translation>
    </message>
    <message>
      <location filename="" />
      <source>The arc has R and %1.</source>
      <translation>El arco tiene R y %1.</translation>
    </message>
    <message>
      <location filename="" />
      <source>The arc has neither R nor I and K.</source>
      <translation>El arco no tiene ni R ni I y K.</translation>
    </message>
    <message>
      <location filename="" />
      <source>The line has both C and R.</source>
      <translation>La línea tiene C y R a la vez.</translation>
    </message>
    <message>
      <location filename="" />
      <source>The line holds %1 and %2.</source>
      <translation>La línea contiene %1 y %2.</translation>
    </message>
    <message>
      <location filename="" />
      <source>The line holds %1, which is neither C1 (on) nor C0 (off).</source>
      <translation>La línea contiene %1, que no es C1 (encendido) ni C0 (apagado).</translation>
    </message>
    <message>
      <location filename="" />
      <source>The line holds %1, which is no number of an input.</source>
      <translation>La línea contiene %1, que no es número de una entrada.</translation>
    </message>
    <message>
      <location filename="" />
      <source>The spindle stands, and a thread is cut by its turns.</source>
      <translation>El husillo está parado, y una rosca se corta por sus vueltas.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Use G90 or G73 for the arc.</source>
      <translation>Use G90 o G73 para el arco.</translation>
    </message>
    <message>
      <location filename="" />
      <source>With input %1 %2 at line %3: %4</source>
      <translation>Con la entrada %1 %2 en la línea %3: %4</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write %1 alone.</source>
      <translation>Escriba sólo %1.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write C1 or C0.</source>
      <translation>Escriba C1 o C0.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write F on the %1 line.</source>
      <translation>Escriba F en la línea de %1.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write G%1Sn.</source>
      <translation>Escriba G%1Sn.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write G04Fn, n in seconds.</source>
      <translation>Escriba G04Fn, n en segundos.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write G35 or G35F2.</source>
      <translation>Escriba G35 o G35F2.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write G36 before it.</source>
      <translation>Escriba G36 antes.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write G40 before.</source>
      <translation>Escriba antes G40.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write G94 with F before.</source>
      <translation>Escriba antes G94 con F.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write G97S before it.</source>
      <translation>Escriba antes G97S.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write I, the depth of the first pass.</source>
      <translation>Escriba I, la profundidad de la primera pasada.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write K, the lead per revolution.</source>
      <translation>Escriba K, el paso por vuelta.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write M19 before.</source>
      <translation>Escriba antes M19.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write M19 or M89 before.</source>
      <translation>Escriba antes M19 o M89.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write its number after P.</source>
      <translation>Escriba su número tras P.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write the coordinates.</source>
      <translation>Escriba las coordenadas.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write the degrees.</source>
      <translation>Escriba los grados.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write the input's number.</source>
      <translation>Escriba el número de la entrada.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Write the size in full.</source>
      <translation>Escriba el tamaño completo.</translation>
    </message>
    <message>
      <location filename="" />
      <source>X of the last pass is missing.</source>
      <translation>Falta la X de la última pasada.</translation>
    </message>
    <message>
      <location filename="" />
      <source>Z, the end of the thread, is missing.</source>
      <translation>Falta Z, el final de la rosca.</translation>
    </message>
    <message>
      <location filename="" />
      <source>a drill</source>
      <translation>una broca</translation>
    </message>
    <message>
      <location filename="" />
      <source>a reamer</source>
      <translation>un escariador</translation>
    </message>
    <message>
      <location filename="" />
      <source>a tap</source>
      <translation>un macho</translation>
    </message>
    <message>
      <location filename="" />
      <source>begins a loop, and its lines and LF would have to follow</source>
      <translation>empieza un lazo, y sus líneas y LF tendrían que seguir</translation>
    </message>
    <message>
      <location filename="" />
      <source>begins a subroutine, and those stand in programs</source>
      <translation>empieza una subrutina, y ésas van en programas</translation>
    </message>
    <message>
      <location filename="" />
      <source>begins nose compensation, which looks at the lines that follow</source>
      <translation>empieza compensación de punta, que mira las líneas que siguen</translation>
    </message>
    <message>
      <location filename="" />
      <source>belongs to plane switching, whose lines would have to follow</source>
      <translation>pertenece a un cambio de plano, cuyas líneas tendrían que seguir</translation>
    </message>
    <message>
      <location filename="" />
      <source>calls a subroutine, and those stand in programs</source>
      <translation>llama una subrutina, y ésas van en programas</translation>
    </message>
    <message>
      <location filename="" />
      <source>coarse feed</source>
      <translation>avance burdo</translation>
    </message>
    <message>
      <location filename="" />
      <source>cuts a contour, and its lines would have to follow</source>
      <translation>corta un contorno, y tendrían que seguir sus líneas</translation>
    </message>
    <message>
      <location filename="" />
      <source>ends a contour, and there is none</source>
      <translation>termina un contorno, y no hay ninguno</translation>
    </message>
    <message>
      <location filename="" />
      <source>ends a loop, and there is none</source>
      <translation>termina un lazo, y no hay ninguno</translation>
    </message>
    <message>
      <location filename="" />
      <source>ends a subroutine, and there is none</source>
      <translation>termina una subrutina, y no hay ninguna</translation>
    </message>
    <message>
      <location filename="" />
      <source>ends nose compensation, which looks at the lines around it</source>
      <translation>termina compensación de punta, que mira las líneas alrededor</translation>
    </message>
    <message>
      <location filename="" />
      <source>in/min</source>
      <translation>pulg/min</translation>
    </message>
    <message>
      <location filename="" />
      <source>in/rev</source>
      <translation>pulg/rev</translation>
    </message>
    <message>
      <location filename="" />
      <source>needs a G92 on the next line</source>
      <translation>necesita un G92 en la línea siguiente</translation>
    </message>
    <message>
      <location filename="" />
      <source>nose compensation</source>
      <translation>compensación de punta</translation>
    </message>
    <message>
      <location filename="" />
      <source>off</source>
      <translation>apagada</translation>
    </message>
    <message>
      <location filename="" />
      <source>on</source>
      <translation>encendida</translation>
    </message>
    <message>
      <location filename="" />
      <source>speed limits</source>
      <translation>topes de velocidad</translation>
    </message>
    <message>
      <location filename="" />
      <source>spindle mode</source>
      <translation>modo de husillo</translation>
    </message>
    <message>
      <location filename="" />
      <source>the depth of a peck</source>
      <translation>la profundidad de un picoteo</translation>
    </message>
    <message>
      <location filename="" />
      <source>the distance before the cut at which the feed begins</source>
      <translation>la distancia antes del corte en que empieza el avance</translation>
    </message>
    <message>
      <location filename="" />
      <source>the greatest depth of cut</source>
      <translation>la mayor profundidad de corte</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>ALARMS</source>
      <translation>ALARMAS</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>EDIT</source>
      <translation>EDITAR</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>FILE</source>
      <translation>ARCHIVO</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>FIT</source>
      <translation>TODO</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>MENU</source>
      <translation>MENÚ</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>READOUT</source>
      <translation>LECTURA</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>SEARCHTO</source>
      <translation>BUSCAR A</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>SECCMP</source>
      <translation>COMPSEC</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>SPECIAL</source>
      <translation>ESPECIAL</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>TOOLS</source>
      <translation>HERRAM</translation>
    </message>
    <message>
      <location filename="app/automatic/automatic_view.py" />
      <source>To line</source>
      <translation>A la línea</translation>
    </message>
    <message>
      <location filename="app/compose/desk_part.py" />
      <source>LINE {line}: {check}</source>
      <translation>LÍNEA {line}: {check}</translation>
    </message>
    <message>
      <location filename="app/compose/desk_part.py" />
      <source>Say another stock, or other shapes of tools.</source>
      <translation>Indique otro material u otras formas de herramienta.</translation>
    </message>
    <message>
      <location filename="app/compose/desk_part.py" />
      <source>Say it anew on the page PART.</source>
      <translation>Indíquelo de nuevo en la página PIEZA.</translation>
    </message>
    <message>
      <location filename="app/compose/desk_part.py" />
      <source>THE PART IS NOT PROVED AS IT WAS SAID</source>
      <translation>LA PIEZA NO SE PROBÓ COMO SE INDICÓ</translation>
    </message>
    <message>
      <location filename="app/compose/desk_part.py" />
      <source>The part could not be proved: %1.</source>
      <translation>La pieza no se pudo comprobar: %1.</translation>
    </message>
    <message>
      <location filename="app/compose/desk_part.py" />
      <source>The stock that was said cannot be used, and is assumed: %1.</source>
      <translation>El material indicado no se puede usar y se supone: %1.</translation>
    </message>
    <message>
      <location filename="app/compose/gauge_wire.py" />
      <source>THE GAUGE: {why}; F5 LISTENS AGAIN</source>
      <translation>EL CALIBRADOR: {why}; F5 VUELVE A ESCUCHAR</translation>
    </message>
    <message>
      <location filename="app/compose/gauge_wire.py" />
      <source>THE GAUGE: {why}; MEASURE AGAIN</source>
      <translation>EL CALIBRADOR: {why}; MIDA DE NUEVO</translation>
    </message>
    <message>
      <location filename="app/compose/gauge_wire.py" />
      <source>The gauge has been silent for {minutes} min: its switch, its cable.</source>
      <translation>El calibrador calla desde hace {minutes} min: su interruptor, su cable.</translation>
    </message>
    <message>
      <location filename="app/compose/gauge_wire.py" />
      <source>The gauge is listened to: {count} readings.</source>
      <translation>Se escucha al calibrador: {count} lecturas.</translation>
    </message>
    <message>
      <location filename="app/compose/gauge_wire.py" />
      <source>The gauge is not listened to; F5 begins.</source>
      <translation>No se escucha al calibrador; F5 empieza.</translation>
    </message>
    <message>
      <location filename="app/compose/journal.py" />
      <source>MEASURED PARTS CANNOT BE KEPT: %1</source>
      <translation>LAS PIEZAS MEDIDAS NO SE PUEDEN GUARDAR: %1</translation>
    </message>
    <message>
      <location filename="app/compose/journal.py" />
      <source>loaded to run</source>
      <translation>cargado para correr</translation>
    </message>
    <message>
      <location filename="app/compose/journal.py" />
      <source>the store is closed</source>
      <translation>el almacén está cerrado</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>MTCONNECT</source>
      <translation>MTCONNECT</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>NO SHOP-FLOOR DATA: {why}</source>
      <translation>SIN DATOS PARA LA PLANTA: {why}</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>SIMULATED</source>
      <translation>SIMULADO</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>SIMULATED SLIDES · REAL SPINDLE</source>
      <translation>CARROS SIMULADOS · HUSILLO REAL</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>THE RECORD OF THE SCOPE</source>
      <translation>EL REGISTRO DEL OSCILOSCOPIO</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>WHAT KEEPS OFFSETS AND COUNTS</source>
      <translation>LO QUE GUARDA COMPENSACIONES Y CUENTAS</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>WHAT READS THE PENDANT</source>
      <translation>LO QUE LEE EL MANDO COLGANTE</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>WHAT TALKS TO THE INVERTER</source>
      <translation>LO QUE HABLA CON EL VARIADOR</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>WHAT WATCHES THE PROGRAM'S FILE</source>
      <translation>LO QUE VIGILA EL ARCHIVO DEL PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>machine file: %1</source>
      <translation>archivo de máquina: %1</translation>
    </message>
    <message>
      <location filename="app/compose/screen_desk.py" />
      <source>{what} HAS ENDED: SAVE THE LOG, END TURNDESK AND START IT AGAIN</source>
      <translation>{what} TERMINÓ: GUARDE LA BITÁCORA, CIERRE TURNDESK Y ÁBRALO OTRA VEZ</translation>
    </message>
    <message>
      <location filename="app/compose/stored_offsets.py" />
      <source>THE OFFSETS COME FROM A FILE (--offsets) AND ARE READ ONLY: CHANGE THE FILE, OR START WITHOUT IT</source>
      <translation>LAS COMPENSACIONES VIENEN DE UN ARCHIVO (--offsets) Y SON DE SÓLO LECTURA: CAMBIE EL ARCHIVO, O ARRANQUE SIN ÉL</translation>
    </message>
    <message>
      <location filename="app/compose/stored_offsets.py" />
      <source>a tool shape of the store cannot be: %1; %2</source>
      <translation>una forma de herramienta del almacén no puede ser: %1; %2</translation>
    </message>
    <message>
      <location filename="app/compose/stored_offsets.py" />
      <source>mend it on the page of its shape (F8), or with 'turndesk offsets set'</source>
      <translation>corríjala en la página de su forma (F8), o con 'turndesk offsets set'</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>%1 at character %2 of %3; expected %4</source>
      <translation>%1 en el carácter %2 de %3; se esperaba %4</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>%1 divides by zero</source>
      <translation>%1 divide entre cero</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>%1 in %2 is no number; %3</source>
      <translation>%1 en %2 no es un número; %3</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>%1 is too large; type a smaller number</source>
      <translation>%1 es demasiado grande; escriba un número menor</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>%1 stops short; expected %2 at its end</source>
      <translation>%1 queda incompleto; se esperaba %2 al final</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>+ - * / or the end</source>
      <translation>+ - * / o el final</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>a closing bracket</source>
      <translation>un paréntesis de cierre</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>nothing is entered; type a number</source>
      <translation>no se ha escrito nada; escriba un número</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>only numbers and + - * / ( ) count</source>
      <translation>sólo valen números y + - * / ( )</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>the decimal sign is a point</source>
      <translation>el signo decimal es el punto</translation>
    </message>
    <message>
      <location filename="app/desk/arithmetic.py" />
      <source>the entry is longer than %1 characters; type the result</source>
      <translation>la entrada tiene más de %1 caracteres; escriba el resultado</translation>
    </message>
    <message>
      <location filename="app/desk/data_folder.py" />
      <source>TURNDESK_HOME: %1 %2 a file and no folder; name a folder, or unset it</source>
      <translation>TURNDESK_HOME: %1 %2 un archivo y no una carpeta; nombre una carpeta, o quítela</translation>
    </message>
    <message>
      <location filename="app/desk/data_folder.py" />
      <source>lies below %1, which is</source>
      <translation>está debajo de %1, que es</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>A PROGRAM IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R, BEFORE CHOOSING ANOTHER</source>
      <translation>HAY UN PROGRAMA EN CURSO: DEJE QUE TERMINE, O PÁRELO Y OPRIMA R, ANTES DE ELEGIR OTRO</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>AN ALARM STANDS: PRESS R TO ACKNOWLEDGE IT FIRST</source>
      <translation>HAY UNA ALARMA: OPRIMA PRIMERO R PARA RECONOCERLA</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>BLOCK DELETE CHANGES WHAT WAS PROVED: ONLY BETWEEN TWO CYCLES</source>
      <translation>EL SALTO DE BLOQUE CAMBIA LO COMPROBADO: SÓLO ENTRE DOS CICLOS</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>CHOOSE A PROGRAM FIRST: BLOCK DELETE BELONGS TO THE PROGRAM THAT IS PROVED</source>
      <translation>ELIJA PRIMERO UN PROGRAMA: EL SALTO DE BLOQUE PERTENECE AL PROGRAMA QUE SE COMPRUEBA</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>CONTROL SILENT</source>
      <translation>CONTROL SIN RESPUESTA</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>Esc at the screen</source>
      <translation>Esc en la pantalla</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>FILE NOT FOUND: %1</source>
      <translation>NO SE ENCONTRÓ EL ARCHIVO: %1</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>LOOK: {what}; H HOLDS THE FEED</source>
      <translation>MIRE: {what}; H RETIENE EL AVANCE</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>NOT KEPT, AND LOST BY CLOSING: {what}; MAKE ROOM, OR PRESS Y TO CLOSE, ESC TO STAY</source>
      <translation>SIN GUARDAR, Y SE PIERDE AL CERRAR: {what}; HAGA ESPACIO, U OPRIMA Y PARA CERRAR, ESC PARA SEGUIR</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>NOT KEPT: %1</source>
      <translation>NO SE GUARDÓ: %1</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>PRESS BOTH PALM BUTTONS</source>
      <translation>OPRIMA LOS DOS BOTONES DE PALMA</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>PRESS BOTH PALM BUTTONS (F11 + F12)</source>
      <translation>OPRIMA LOS DOS BOTONES DE PALMA (F11 + F12)</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>PRESS CYCLE START</source>
      <translation>OPRIMA INICIO DE CICLO</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>PRESS CYCLE START (F12)</source>
      <translation>OPRIMA INICIO DE CICLO (F12)</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>REFUSED: %1</source>
      <translation>RECHAZADO: %1</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>RELEASE THE BUTTON</source>
      <translation>SUELTE EL BOTÓN</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>RELEASE THE BUTTON (U)</source>
      <translation>SUELTE EL BOTÓN (U)</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>RELEASE THE BUTTON BY HAND, U WRITES HERE; F1 LEAVES THE PAGE</source>
      <translation>SUELTE EL BOTÓN A MANO, AQUÍ LA U ESCRIBE; F1 SALE DE LA PÁGINA</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>RELEASE THE BUTTON, F1 LEAVES THE PAGE</source>
      <translation>SUELTE EL BOTÓN, F1 SALE DE LA PÁGINA</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>THE DRIVES ARE ON</source>
      <translation>LOS SERVOS ESTÁN ENCENDIDOS</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>THE E-STOP IS NOT PRESSED</source>
      <translation>EL PARO DE EMERGENCIA NO ESTÁ OPRIMIDO</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>THE E-STOP IS STILL PRESSED: %1 FIRST</source>
      <translation>EL PARO DE EMERGENCIA SIGUE OPRIMIDO: PRIMERO %1</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>THE INTERRUPTED PROGRAM {name} IS NOT IN THE FOLDER: F2</source>
      <translation>EL PROGRAMA INTERRUMPIDO {name} NO ESTÁ EN LA CARPETA: F2</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>THE MACHINE IS MOVING: PRESS H FOR FEED HOLD FIRST</source>
      <translation>LA MÁQUINA SE MUEVE: OPRIMA PRIMERO H, RETENCIÓN DE AVANCE</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>Y MEANS SOMETHING ON THE AUTOMATIC PAGE, WITH THE DRIVES ON</source>
      <translation>LA TECLA Y SIRVE EN LA PÁGINA AUTOMÁTICO, CON LOS SERVOS ENCENDIDOS</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>key or finger at the screen</source>
      <translation>tecla o dedo en la pantalla</translation>
    </message>
    <message>
      <location filename="app/desk/desk.py" />
      <source>{name} IS NOT LOADED: A JOB WAS INTERRUPTED</source>
      <translation>{name} NO SE CARGA: HAY UN TRABAJO INTERRUMPIDO</translation>
    </message>
    <message>
      <location filename="app/desk/formats.py" />
      <source>%1 GB</source>
      <translation>%1 GB</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source> (ITS TEXT HAS CHANGED SINCE)</source>
      <translation> (SU TEXTO HA CAMBIADO DESDE ENTONCES)</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source> PASS {now} OF {all}</source>
      <translation> PASADA {now} DE {all}</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>BEGINS AT LINE 1, {text}, FROM WHERE T{tool} STANDS NOW: {start}; ESC TAKES IT BACK</source>
      <translation>EMPIEZA EN LA LÍNEA 1, {text}, DESDE DONDE ESTÁ T{tool}: {start}; ESC LO ANULA</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>INTERRUPTED: {program} LINE {line}{passed}, T{tool}, PART {part}, {at}: {why}{changed}</source>
      <translation>INTERRUMPIDO: {program} LÍNEA {line}{passed}, T{tool}, PIEZA {part}, {at}: {why}{changed}</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>LINE {line} WAS INTERRUPTED: F6 SHOWS THE WAY OUT AND GOES ON THERE; Y, THEN THE START: LINE 1</source>
      <translation>LA LÍNEA {line} SE INTERRUMPIÓ: F6 MUESTRA LA SALIDA Y SIGUE ALLÍ; OPRIMA Y, LUEGO EL ARRANQUE: LÍNEA 1</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>LINE {line} WAS INTERRUPTED: JOG THE TOOL CLEAR; Y, THEN THE START: LINE 1</source>
      <translation>LA LÍNEA {line} SE INTERRUMPIÓ: SAQUE LA HERRAMIENTA A MANO; OPRIMA Y, LUEGO EL ARRANQUE: LÍNEA 1</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>STANDS AT {stood} FROM HOME</source>
      <translation>ESTÁ EN {stood} DESDE LA REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>STOOD AT {stood} FROM HOME</source>
      <translation>ESTABA EN {stood} DESDE LA REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>STOOD AT {stood} FROM HOME; WHERE IT STANDS NOW IS NOT KNOWN BEFORE HOMING</source>
      <translation>ESTABA EN {stood} DESDE LA REFERENCIA; DÓNDE ESTÁ AHORA NO SE SABE SIN REFERENCIAR</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>STOOD AT {stood}, STANDS AT {now} FROM HOME</source>
      <translation>ESTABA EN {stood}, ESTÁ EN {now} DESDE LA REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/desk/interrupted_notice.py" />
      <source>T{tool} MAY STAND IN THE PART OF {program} LINE {line}: Y GIVES THAT JOB UP FOR {name}, ESC KEEPS IT</source>
      <translation>T{tool} PUEDE ESTAR EN LA PIEZA DE {program} LÍNEA {line}: LA TECLA Y ABANDONA ESE TRABAJO POR {name}, ESC LO CONSERVA</translation>
    </message>
    <message>
      <location filename="app/desk/machine_file_changes.py" />
      <source>THE MACHINE FILE HAS CHANGED ({count}): F10, MACHINE FILE SHOWS IT AND ACCEPTS IT</source>
      <translation>EL ARCHIVO DE MÁQUINA HA CAMBIADO ({count}): F10, ARCHIVO DE MÁQUINA LO MUESTRA Y LO ACEPTA</translation>
    </message>
    <message>
      <location filename="app/desk/machine_status.py" />
      <source>ALARM %1: %2</source>
      <translation>ALARMA %1: %2</translation>
    </message>
    <message>
      <location filename="app/desk/machine_status.py" />
      <source>FEED HOLD %1: %2</source>
      <translation>RETENCIÓN DE AVANCE %1: %2</translation>
    </message>
    <message>
      <location filename="app/desk/machine_status.py" />
      <source>PROGRAM STOP</source>
      <translation>PARO DE PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/desk/machine_status.py" />
      <source>WAITING: %1</source>
      <translation>ESPERANDO: %1</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>C AXIS</source>
      <translation>EJE C</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>COARSE FEED</source>
      <translation>AVANCE BURDO</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>COLLET</source>
      <translation>BOQUILLA</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>COMMENT</source>
      <translation>COMENTARIO</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>COOLANT</source>
      <translation>REFRIG.</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>D OFFSET</source>
      <translation>COMPENSACIÓN D</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>DISTANCE</source>
      <translation>DISTANCIA</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>F THAT IS A RAPID</source>
      <translation>F QUE ES RÁPIDO</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>FEED</source>
      <translation>AVANCE</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>FEED MODE</source>
      <translation>MODO DE AVANCE</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>FREE</source>
      <translation>LIBRE</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>G01 FEED</source>
      <translation>AVANCE G01</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>G10 AT NEXT T</source>
      <translation>G10 EN T SIG.</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>G10 IN FORCE</source>
      <translation>G10 VIGENTE</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>G76 … G77</source>
      <translation>G76 … G77</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>G92 PRESET</source>
      <translation>PREAJUSTE G92</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>G97 %1 RPM</source>
      <translation>G97 %1 RPM</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>LOCKED</source>
      <translation>BLOQUEADO</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>M FUNCTIONS</source>
      <translation>FUNCIONES M</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>NOSE COMP</source>
      <translation>COMP DE PUNTA</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>OFF</source>
      <translation>APAGADO</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>RAPID</source>
      <translation>RÁPIDO</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>RAPID RATE</source>
      <translation>VELOC DE RÁPIDO</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>SFM</source>
      <translation>PIES/MIN</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>SPEED</source>
      <translation>VELOC</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>SPINDLE</source>
      <translation>HUSILLO</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>TOOL</source>
      <translation>HERRAMIENTA</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>TOOL OFFSET</source>
      <translation>COMP HERRAM</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>UNITS</source>
      <translation>UNIDADES</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>X WORDS</source>
      <translation>PALABRAS X</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>cut feed</source>
      <translation>avance de corte</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>feed mode</source>
      <translation>modo de avance</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>first feed</source>
      <translation>primer avance</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>rapid rate</source>
      <translation>velocidad de rápido</translation>
    </message>
    <message>
      <location filename="app/desk/modal_rows.py" />
      <source>tool offset</source>
      <translation>compensación de herramienta</translation>
    </message>
    <message>
      <location filename="app/desk/persistence.py" />
      <source>nothing is kept here; start turndesk with a folder that can be written (TURNDESK_HOME)</source>
      <translation>aquí no se guarda nada; arranque turndesk con una carpeta en la que se pueda escribir (TURNDESK_HOME)</translation>
    </message>
    <message>
      <location filename="app/desk/program_folder.py" />
      <source>{name} HAS CHANGED ON THE DISK: F2 READS IT ANEW, THE START RUNS WHAT IS SHOWN</source>
      <translation>{name} CAMBIÓ EN EL DISCO: F2 LO LEE DE NUEVO, EL ARRANQUE CORRE LO QUE SE MUESTRA</translation>
    </message>
    <message>
      <location filename="app/desk/program_folder.py" />
      <source>{name} IS NOT ON THE DISK ANY MORE: WHAT IS SHOWN IS WHAT RUNS</source>
      <translation>{name} YA NO ESTÁ EN EL DISCO: LO QUE SE MUESTRA ES LO QUE CORRE</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>%1 Assumed: %2.</source>
      <translation>%1 Supuesto: %2.</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>DRAWING</source>
      <translation>DIBUJANDO</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>EMPTY</source>
      <translation>VACÍO</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>PROVING</source>
      <translation>COMPROBANDO</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>PROVING THE PART OF</source>
      <translation>PROBANDO LA PIEZA DE</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>READING</source>
      <translation>LEYENDO</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>READY</source>
      <translation>LISTO</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>REFUSED</source>
      <translation>RECHAZADO</translation>
    </message>
    <message>
      <location filename="app/desk/program_loading.py" />
      <source>UNREADABLE</source>
      <translation>ILEGIBLE</translation>
    </message>
    <message>
      <location filename="app/desk/program_renewal.py" />
      <source>NO NEXT PART WITH THE CHANGED OFFSETS: {why}</source>
      <translation>NO HAY PRÓXIMA PIEZA CON LAS COMPENSACIONES CAMBIADAS: {why}</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source> %1 BLOCKS</source>
      <translation> %1 BLOQUES</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source> (%1 MORE)</source>
      <translation> (%1 MÁS)</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>%1  ·  WHAT TO DO: %2</source>
      <translation>%1  ·  QUÉ HACER: %2</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>%1 CANNOT BE LOADED: %2; PRESS F2 FOR ANOTHER</source>
      <translation>NO SE PUEDE CARGAR %1: %2; OPRIMA F2 PARA OTRO</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>A KEY THAT STOPS IS HELD DOWN: LET IT GO FIRST</source>
      <translation>HAY UNA TECLA DE PARO OPRIMIDA: SUÉLTELA PRIMERO</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>ALARM: PUT THE CAUSE RIGHT, THEN PRESS R TO ACKNOWLEDGE</source>
      <translation>ALARMA: CORRIJA LA CAUSA Y OPRIMA R PARA RECONOCERLA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>ANOTHER WINDOW HAS THE KEYBOARD: NO KEY STOPS HERE. PRESS THE BUTTONS, OR TOUCH THIS WINDOW</source>
      <translation>OTRA VENTANA TIENE EL TECLADO: AQUÍ NO PARA NINGUNA TECLA. PULSE LOS BOTONES O TOQUE ESTA VENTANA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>CAUSE: %1</source>
      <translation>CAUSA: %1</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>COMING TO REST</source>
      <translation>DETENIÉNDOSE</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>CYCLES ARE STARTED ON THE AUTOMATIC PAGE: PRESS F1, THEN F2</source>
      <translation>LOS CICLOS SE INICIAN EN LA PÁGINA AUTOMÁTICO: OPRIMA F1 Y LUEGO F2</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>DRIVES ARE OFF: PRESS D FOR DRIVES ON</source>
      <translation>SERVOS APAGADOS: OPRIMA D PARA ENCENDERLOS</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>E-STOP: MAKE THE MACHINE SAFE, %1, THEN PRESS D FOR DRIVES ON</source>
      <translation>PARO DE EMERGENCIA: PONGA LA MÁQUINA SEGURA, %1, Y OPRIMA D PARA ENCENDER SERVOS</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>FILE NOT FOUND, PRESS ANY KEY TO CONTINUE</source>
      <translation>NO SE ENCONTRÓ EL ARCHIVO, OPRIMA CUALQUIER TECLA PARA CONTINUAR</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>FILE TO BE PROCESSED</source>
      <translation>ARCHIVO A PROCESAR</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>LINE %1: </source>
      <translation>LÍNEA %1: </translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>LINE %1: %2 %3</source>
      <translation>LÍNEA %1: %2 %3</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>NO START: %1</source>
      <translation>NO ARRANCA: %1</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>NO START: A BACKUP IS BEING RESTORED</source>
      <translation>NO ARRANCA: SE ESTÁ RESTAURANDO UN RESPALDO</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>NO START: THE PROGRAM IS BEING READ ANEW</source>
      <translation>NO ARRANCA: SE ESTÁ LEYENDO DE NUEVO EL PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>NOT COUNTED AS A PART: %1</source>
      <translation>NO CONTADO COMO PIEZA: %1</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>ONE PALM BUTTON ALONE DOES NOT START: PRESS BOTH WITHIN HALF A SECOND</source>
      <translation>UN SOLO BOTÓN DE PALMA NO ARRANCA: OPRIMA LOS DOS EN MEDIO SEGUNDO</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>ONE PALM BUTTON WAS HELD LONGER THAN HALF A SECOND: LET BOTH GO, THEN PRESS BOTH</source>
      <translation>UN BOTÓN DE PALMA SE SOSTUVO MÁS DE MEDIO SEGUNDO: SUELTE LOS DOS Y OPRIMA LOS DOS</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>PAUSE HOLDS THE FEED (SO DO H AND ESC), SCROLL LOCK IS THE E-STOP</source>
      <translation>PAUSA RETIENE EL AVANCE (TAMBIÉN H Y ESC), BLOQ DESPL ES EL PARO DE EMERGENCIA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>PRESS F2 TO CHOOSE A PROGRAM</source>
      <translation>OPRIMA F2 PARA ELEGIR UN PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>PRESS Y TO GIVE THE PROGRAM UP, ESC TO KEEP IT</source>
      <translation>OPRIMA Y PARA ABANDONAR EL PROGRAMA, ESC PARA CONSERVARLO</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>PRESS Y TO TWIST THE E-STOP OUT, ESC TO LEAVE IT IN</source>
      <translation>OPRIMA Y PARA SOLTAR EL PARO DE EMERGENCIA, ESC PARA DEJARLO OPRIMIDO</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>PROVING FOUND ERRORS</source>
      <translation>LA COMPROBACIÓN HALLÓ ERRORES</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>THE CONTROL DOES NOT ANSWER: PRESS E-STOP; WHAT IS SHOWN IS NOT OF NOW</source>
      <translation>EL CONTROL NO RESPONDE: OPRIMA EL PARO DE EMERGENCIA; LO QUE SE VE NO ES DE AHORA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>THE E-STOP IS THE RED BUTTON AT THE MACHINE: HIT IT. THIS KEY HAS HELD THE FEED</source>
      <translation>EL PARO DE EMERGENCIA ES EL BOTÓN ROJO DE LA MÁQUINA: OPRÍMALO. ESTA TECLA RETUVO EL AVANCE</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>THE PROGRAM IS NOT PROVED YET AND WILL NOT START</source>
      <translation>EL PROGRAMA AÚN NO ESTÁ COMPROBADO Y NO ARRANCARÁ</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>THE SLIDES ARE LOOKING FOR HOME</source>
      <translation>LOS CARROS BUSCAN SU REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>TO GO ON %1; R GIVES THE PROGRAM UP</source>
      <translation>PARA SEGUIR %1; R ABANDONA EL PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>TO START</source>
      <translation>PARA ARRANCAR</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>TO START %1</source>
      <translation>PARA ARRANCAR %1</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>TYPE A NAME, OR MARK A PROGRAM WITH THE ARROWS, BEFORE EDITING</source>
      <translation>ESCRIBA UN NOMBRE, O MARQUE UN PROGRAMA CON LAS FLECHAS, ANTES DE EDITAR</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>WHAT TO DO: %1  ·  R ACKNOWLEDGES, F7 LISTS</source>
      <translation>QUÉ HACER: %1  ·  R RECONOCE, F7 LISTA</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>WILL NOT RUN: %1</source>
      <translation>NO CORRERÁ: %1</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>WILL NOT RUN: %1%2%3</source>
      <translation>NO CORRERÁ: %1%2%3</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>WILL NOT START</source>
      <translation>NO ARRANCARÁ</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>WILL NOT START: %1</source>
      <translation>NO ARRANCARÁ: %1</translation>
    </message>
    <message>
      <location filename="app/desk/prompt_line.py" />
      <source>WILL NOT START: NO OFFSET WAS EVER SET FOR %1 (F8 SETS THEM)</source>
      <translation>NO ARRANCARÁ: NUNCA SE PUSO COMPENSACIÓN PARA %1 (F8 LA PONE)</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>%1  ·  CONTROL IN %2</source>
      <translation>%1  ·  CONTROL EN %2</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>BLOCK DELETE</source>
      <translation>SALTO BLOQUE</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>COLLET ?</source>
      <translation>PINZA ?</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>COLLET CLOSED</source>
      <translation>BOQUILLA CERRADA</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>COLLET OPEN</source>
      <translation>BOQUILLA ABIERTA</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>CYCLE REPEAT</source>
      <translation>REPETIR CICLO</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>DISTANCE TO GO</source>
      <translation>DISTANCIA POR RECORRER</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>INCH</source>
      <translation>PULGADAS</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>LIVE TOOL</source>
      <translation>HERR MOTRIZ</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>MACHINE</source>
      <translation>MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>MM</source>
      <translation>MM</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>NO COUNT</source>
      <translation>SIN CONT</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>OPTIONAL STOP</source>
      <translation>PARO OPCIONAL</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>POSITION</source>
      <translation>POSICIÓN</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>SINGLE BLOCK</source>
      <translation>BLOQUE A BLOQUE</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>SPINDLE COASTS</source>
      <translation>HUSILLO POR INERCIA</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>SPINDLE FWD</source>
      <translation>HUSILLO ADELANTE</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>SPINDLE REV</source>
      <translation>HUSILLO REVERSA</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>SPINDLE UNKNOWN</source>
      <translation>HUSILLO DESCONOCIDO</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>TABLE TURNED</source>
      <translation>MESA GIRADA</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>TILTED PLANE</source>
      <translation>PLANO INCLINADO</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>TILTED PLANE OF LINE {line}</source>
      <translation>PLANO INCLINADO DE LA LÍNEA {line}</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>UNKNOWN</source>
      <translation>DESCONOCIDO</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>WORKPIECE</source>
      <translation>PIEZA</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>X IS A DIAMETER</source>
      <translation>X ES DIÁMETRO</translation>
    </message>
    <message>
      <location filename="app/desk/readouts.py" />
      <source>X IS A RADIUS</source>
      <translation>X ES RADIO</translation>
    </message>
    <message>
      <location filename="app/desk/screen_settings.py" />
      <source>AS THE PROGRAM</source>
      <translation>COMO EL PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/desk/stored_shapes.py" />
      <source>a profile is three points or more, Z and X in mm: 0,0 2.5,0 1.2,1.5</source>
      <translation>un perfil son tres puntos o más, Z y X en mm: 0,0 2.5,0 1.2,1.5</translation>
    </message>
    <message>
      <location filename="app/desk/unheard_notice.py" />
      <source>INPUTS</source>
      <translation>ENTRADAS</translation>
    </message>
    <message>
      <location filename="app/desk/unheard_notice.py" />
      <source>NOT KNOWN: {what} · WHAT IS SHOWN IS THE LAST THAT WAS HEARD</source>
      <translation>DESCONOCIDO: {what} · SE MUESTRA LO ÚLTIMO QUE SE OYÓ</translation>
    </message>
    <message>
      <location filename="app/desk/unheard_notice.py" />
      <source>OUTPUTS</source>
      <translation>SALIDAS</translation>
    </message>
    <message>
      <location filename="app/desk/unheard_notice.py" />
      <source>POSITIONS</source>
      <translation>POSICIONES</translation>
    </message>
    <message>
      <location filename="app/desk/unheard_notice.py" />
      <source>SPINDLE UNKNOWN – SPINDLE MAY TURN: PRESS E-STOP</source>
      <translation>HUSILLO DESCONOCIDO – PUEDE GIRAR: PULSE PARO DE EMERGENCIA</translation>
    </message>
    <message>
      <location filename="app/desk/unheard_notice.py" />
      <source>{what} UNKNOWN: THE MACHINE IS NOT HEARD</source>
      <translation>{what}: DESCONOCIDO, NO SE OYE A LA MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/editor/document.py" />
      <source>%1 CANNOT NAME A PROGRAM: LETTERS, DIGITS, DOT, DASH AND BLANK</source>
      <translation>%1 NO PUEDE NOMBRAR UN PROGRAMA: LETRAS, NÚMEROS, PUNTO, GUION Y ESPACIO</translation>
    </message>
    <message>
      <location filename="app/editor/document.py" />
      <source>%1 IS NO ENDING OF A PROGRAM: TAKE NONE, OR ONE OF %2</source>
      <translation>%1 NO ES TERMINACIÓN DE PROGRAMA: NINGUNA, O UNA DE %2</translation>
    </message>
    <message>
      <location filename="app/editor/document.py" />
      <source>%1 WOULD BE HIDDEN: TAKE A NAME THAT BEGINS WITH A LETTER OR DIGIT</source>
      <translation>%1 QUEDARÍA OCULTO: USE UN NOMBRE QUE EMPIECE CON LETRA O NÚMERO</translation>
    </message>
    <message>
      <location filename="app/editor/document.py" />
      <source>%1 has over %2 lines: too long for this editor; split it elsewhere</source>
      <translation>%1 tiene más de %2 líneas: demasiado para este editor; divídalo en otra parte</translation>
    </message>
    <message>
      <location filename="app/editor/document.py" />
      <source>NO NAME WAS TYPED: A PROGRAM NEEDS ONE</source>
      <translation>NO SE ESCRIBIÓ NOMBRE: UN PROGRAMA NECESITA UNO</translation>
    </message>
    <message>
      <location filename="app/editor/document.py" />
      <source>as it was before editing</source>
      <translation>como estaba antes de editar</translation>
    </message>
    <message>
      <location filename="app/editor/document.py" />
      <source>changed by another program</source>
      <translation>cambiado por otro programa</translation>
    </message>
    <message>
      <location filename="app/editor/document.py" />
      <source>saved in the editor</source>
      <translation>guardado en el editor</translation>
    </message>
    <message>
      <location filename="app/editor/drafts.py" />
      <source>typed and not saved</source>
      <translation>escrito y no guardado</translation>
    </message>
    <message>
      <location filename="app/editor/edited_path_view.py" />
      <source>FARTHER</source>
      <translation>ALEJAR</translation>
    </message>
    <message>
      <location filename="app/editor/edited_path_view.py" />
      <source>HOLD</source>
      <translation>RETENER</translation>
    </message>
    <message>
      <location filename="app/editor/edited_path_view.py" />
      <source>NEARER</source>
      <translation>ACERCAR</translation>
    </message>
    <message>
      <location filename="app/editor/edited_path_view.py" />
      <source>PATH TO THE CURSOR</source>
      <translation>TRAYECTORIA HASTA EL CURSOR</translation>
    </message>
    <message>
      <location filename="app/editor/edited_path_view.py" />
      <source>THE CROSS STANDS ON NO LINE OF THE PATH: AN ARROW TAKES IT TO ONE</source>
      <translation>LA CRUZ NO ESTÁ SOBRE NINGUNA LÍNEA DE LA TRAYECTORIA: UNA FLECHA LA LLEVA A UNA</translation>
    </message>
    <message>
      <location filename="app/editor/edited_path_view.py" />
      <source>VIEW</source>
      <translation>VISTA</translation>
    </message>
    <message>
      <location filename="app/editor/editor.py" />
      <source>%1 IS SAVED</source>
      <translation>%1 QUEDÓ GUARDADO</translation>
    </message>
    <message>
      <location filename="app/editor/editor.py" />
      <source>%1; ESC</source>
      <translation>%1; ESC</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>A PROGRAM IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R, BEFORE EDITING</source>
      <translation>HAY UN PROGRAMA EN CURSO: DEJE QUE TERMINE, O PÁRELO Y OPRIMA R, ANTES DE EDITAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>A SAMPLE IS NOT CHANGED: UNDER WHAT NAME SHALL IT BE SAVED?</source>
      <translation>UNA MUESTRA NO SE CAMBIA: ¿CON QUÉ NOMBRE SE GUARDA?</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>AN EMPTY PROGRAM IS NOT SAVED: WRITE SOMETHING, OR LEAVE WITH F10</source>
      <translation>UN PROGRAMA VACÍO NO SE GUARDA: ESCRIBA ALGO, O SALGA CON F10</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>ARROWS MARK A VERSION, RETURN PUTS IT INTO THE EDITOR; ESC: BACK</source>
      <translation>LAS FLECHAS MARCAN UNA VERSIÓN, RETURN LA PONE EN EL EDITOR; ESC: REGRESA</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>CHOOSE A PROGRAM FIRST (F2), OR TYPE THE NAME OF A NEW ONE THERE</source>
      <translation>ELIJA PRIMERO UN PROGRAMA (F2), O ESCRIBA AHÍ EL NOMBRE DE UNO NUEVO</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>F3 SAVES AND PUTS WHAT WAS WRITTEN ON THE DESK; F1 SAVES AND LEAVES THE DESK AS IT IS</source>
      <translation>F3 GUARDA Y CARGA LO ESCRITO; F1 GUARDA Y DEJA CARGADO LO QUE HAY</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>F6 LEAVES WITHOUT SAVING, F3 SAVES AND LEAVES, ESC GOES ON</source>
      <translation>F6 SALE SIN GUARDAR, F3 GUARDA Y SALE, ESC SIGUE</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>NOBODY KNOWS WHETHER THE SPINDLE TURNS: PRESS E-STOP, NO EDITING BESIDE IT</source>
      <translation>NADIE SABE SI GIRA EL HUSILLO: PULSE PARO DE EMERGENCIA, NO EDITE A SU LADO</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>NOT SAVED YET: F3 SAVES AND LEAVES, F10 LEAVES WITHOUT SAVING</source>
      <translation>AÚN SIN GUARDAR: F3 GUARDA Y SALE, F10 SALE SIN GUARDAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>PRESS F1 TO CREATE A NEW FILE, ESC TO ABORT</source>
      <translation>OPRIMA F1 PARA CREAR UN ARCHIVO NUEVO, ESC PARA CANCELAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>RETURN: NEXT   SHIFT+RETURN: THE ONE BEFORE   TAB: THE OTHER FIELD   ESC: BACK</source>
      <translation>RETURN: SIGUIENTE   SHIFT+RETURN: ANTERIOR   TAB: EL OTRO CAMPO   ESC: REGRESA</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>SAVED. WHAT RUNS IS THE PROGRAM AS IT WAS LOADED: LOAD IT AGAIN (F2) WHEN THE RUN HAS ENDED</source>
      <translation>GUARDADO. LO QUE CORRE ES EL PROGRAMA COMO SE CARGÓ: CÁRGUELO DE NUEVO (F2) CUANDO TERMINE</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>THE MACHINE RUNS THE PROGRAM AS IT WAS LOADED, NOT THIS TEXT: ESC FOR FEED HOLD</source>
      <translation>LA MÁQUINA CORRE EL PROGRAMA COMO SE CARGÓ, NO ESTE TEXTO: ESC PARA RETENCIÓN DE AVANCE</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>THE SPINDLE IS ON: SWITCH IT OFF (M05, OR R FOR RESET) AND LET IT COME TO REST BEFORE EDITING</source>
      <translation>EL HUSILLO ESTÁ ENCENDIDO: APÁGUELO (M05, O R PARA RESET) Y ESPERE QUE SE DETENGA ANTES DE EDITAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>THE SPINDLE STILL COASTS: WAIT UNTIL IT STANDS BEFORE EDITING</source>
      <translation>EL HUSILLO AÚN GIRA POR INERCIA: ESPERE QUE SE DETENGA ANTES DE EDITAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>THERE IS NO PATH TO LOOK AT YET: WRITE A MOVE</source>
      <translation>AÚN NO HAY TRAYECTORIA QUE VER: ESCRIBA UN MOVIMIENTO</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>TYPE A LINE NUMBER AND PRESS RETURN; ESC: BACK</source>
      <translation>ESCRIBA UN NÚMERO DE LÍNEA Y OPRIMA RETURN; ESC: REGRESA</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>VERSION {} IS IN THE EDITOR; SAVE TO KEEP IT, UNDO TO TAKE IT BACK</source>
      <translation>LA VERSIÓN {} ESTÁ EN EL EDITOR; GUARDE PARA CONSERVARLA, DESHAGA PARA QUITARLA</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>WHAT WAS TYPED HERE LAST TIME AND NOT SAVED IS IN THE HISTORY</source>
      <translation>LO QUE SE ESCRIBIÓ AQUÍ LA ÚLTIMA VEZ Y NO SE GUARDÓ ESTÁ EN EL HISTORIAL</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>no history is kept here</source>
      <translation>aquí no se guarda historial</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>{name} IS SAVED; F2 PUTS IT ON THE DESK</source>
      <translation>{name} ESTÁ GUARDADO; F2 LO CARGA</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>{name} IS SAVED; {other} STAYS ON THE DESK</source>
      <translation>{name} ESTÁ GUARDADO; {other} SIGUE CARGADO</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>{name} WAS ONLY LOOKED AT: {other} STAYS ON THE DESK</source>
      <translation>{name} SÓLO SE MIRÓ: {other} SIGUE CARGADO</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>{} IS THERE ALREADY: TAKE ANOTHER NAME</source>
      <translation>{} YA EXISTE: USE OTRO NOMBRE</translation>
    </message>
    <message>
      <location filename="app/editor/editor_messages.py" />
      <source>{} WAS CHANGED BY ANOTHER PROGRAM MEANWHILE: F6 REPLACES IT (IT STAYS IN HISTORY), ESC GOES ON</source>
      <translation>OTRO PROGRAMA CAMBIÓ {} MIENTRAS TANTO: F6 LO REEMPLAZA (QUEDA EN LA HISTORIA), ESC SIGUE</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>A NUMBER FROM 1 TO %1</source>
      <translation>UN NÚMERO DE 1 A %1</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>ABORT</source>
      <translation>CANCELAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>BACK</source>
      <translation>ATRÁS</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>CREATE</source>
      <translation>CREAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>FIND</source>
      <translation>BUSCAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>GO</source>
      <translation>IR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>GO TO</source>
      <translation>IR A</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>GO TO LINE</source>
      <translation>IR A LA LÍNEA</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>HISTORY</source>
      <translation>HISTORIA</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>LEAVE</source>
      <translation>SALIR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>LINE %1 OF %2  ·  %3</source>
      <translation>LÍNEA %1 DE %2  ·  %3</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>NEXT ERR</source>
      <translation>SIG ERR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>NO SAVE</source>
      <translation>NO GUARD</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>NOTHING WAS FOUND THAT IS WRONG</source>
      <translation>NO SE HALLÓ NADA MAL</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>REDO</source>
      <translation>REHACER</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>REPLACE BY</source>
      <translation>CAMBIAR POR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>RESTORE</source>
      <translation>RESTAURAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>SAVE</source>
      <translation>GUARDAR</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>SAVE AS</source>
      <translation>GUARDAR COMO</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>TO LINE</source>
      <translation>A LÍNEA</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>UNDO</source>
      <translation>DESHACER</translation>
    </message>
    <message>
      <location filename="app/editor/editor_view.py" />
      <source>go to</source>
      <translation>ir a</translation>
    </message>
    <message>
      <location filename="app/editor/find_replace.py" />
      <source>%1 FOUND</source>
      <translation>%1 ENCONTRADOS</translation>
    </message>
    <message>
      <location filename="app/editor/find_replace.py" />
      <source>%1, %2 MORE INSIDE LONGER WORDS</source>
      <translation>%1, %2 MÁS DENTRO DE PALABRAS MÁS LARGAS</translation>
    </message>
    <message>
      <location filename="app/editor/find_replace.py" />
      <source>%1, PARTS OF WORDS TOO</source>
      <translation>%1, TAMBIÉN PARTES DE PALABRAS</translation>
    </message>
    <message>
      <location filename="app/editor/find_replace.py" />
      <source>NOT FOUND</source>
      <translation>NO SE ENCONTRÓ</translation>
    </message>
    <message>
      <location filename="app/editor/findings_view.py" />
      <source>ERROR</source>
      <translation>ERROR</translation>
    </message>
    <message>
      <location filename="app/editor/findings_view.py" />
      <source>FINDINGS  ·  %1  ·  %2</source>
      <translation>HALLAZGOS  ·  %1  ·  %2</translation>
    </message>
    <message>
      <location filename="app/editor/findings_view.py" />
      <source>PROVED  ·  %1 BLOCKS  ·  CYCLE %2</source>
      <translation>COMPROBADO  ·  %1 BLOQUES  ·  CICLO %2</translation>
    </message>
    <message>
      <location filename="app/editor/findings_view.py" />
      <source>WARNING</source>
      <translation>AVISO</translation>
    </message>
    <message>
      <location filename="app/editor/heading_view.py" />
      <source>KEYBOARD</source>
      <translation>TECLADO</translation>
    </message>
    <message>
      <location filename="app/editor/highlight_view.py" />
      <source>END</source>
      <translation>EXTREMO</translation>
    </message>
    <message>
      <location filename="app/editor/live_proof.py" />
      <source>PROVING FAILED: %1</source>
      <translation>FALLÓ LA COMPROBACIÓN: %1</translation>
    </message>
    <message>
      <location filename="app/editor/question_view.py" />
      <source>%1 REPLACED</source>
      <translation>%1 CAMBIADOS</translation>
    </message>
    <message>
      <location filename="app/editor/question_view.py" />
      <source>ALL</source>
      <translation>TODO</translation>
    </message>
    <message>
      <location filename="app/editor/question_view.py" />
      <source>BEFORE</source>
      <translation>ANTERIOR</translation>
    </message>
    <message>
      <location filename="app/editor/question_view.py" />
      <source>NEXT</source>
      <translation>SIGUE</translation>
    </message>
    <message>
      <location filename="app/editor/question_view.py" />
      <source>PARTS</source>
      <translation>PIEZAS</translation>
    </message>
    <message>
      <location filename="app/editor/question_view.py" />
      <source>REPLACE</source>
      <translation>CAMBIAR</translation>
    </message>
    <message>
      <location filename="app/editor/question_view.py" />
      <source>WHOLE</source>
      <translation>COMPLETA</translation>
    </message>
    <message>
      <location filename="app/editor/text_view.py" />
      <source>CHANGED</source>
      <translation>CAMBIADO</translation>
    </message>
    <message>
      <location filename="app/editor/text_view.py" />
      <source>SAMPLE</source>
      <translation>MUESTRA</translation>
    </message>
    <message>
      <location filename="app/editor/text_view.py" />
      <source>SAMPLE, CHANGED</source>
      <translation>MUESTRA, CAMBIADA</translation>
    </message>
    <message>
      <location filename="app/editor/versions.py" />
      <source>COMPARING</source>
      <translation>COMPARANDO</translation>
    </message>
    <message>
      <location filename="app/editor/versions.py" />
      <source>NO VERSION IS KEPT OF THIS PROGRAM YET</source>
      <translation>TODAVÍA NO SE GUARDA NINGUNA VERSIÓN DE ESTE PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/editor/versions.py" />
      <source>THE SAME AS IN THE EDITOR</source>
      <translation>IGUAL QUE EN EL EDITOR</translation>
    </message>
    <message>
      <location filename="app/editor/versions.py" />
      <source>no version %1 of %2 is kept here</source>
      <translation>no se guarda la versión %1 de %2</translation>
    </message>
    <message>
      <location filename="app/editor/versions_view.py" />
      <source>%1 bytes</source>
      <translation>%1 bytes</translation>
    </message>
    <message>
      <location filename="app/editor/versions_view.py" />
      <source>DOWN</source>
      <translation>ABAJO</translation>
    </message>
    <message>
      <location filename="app/editor/versions_view.py" />
      <source>NEWER</source>
      <translation>MÁS NVA</translation>
    </message>
    <message>
      <location filename="app/editor/versions_view.py" />
      <source>OLDER</source>
      <translation>MÁS ANT</translation>
    </message>
    <message>
      <location filename="app/editor/versions_view.py" />
      <source>UP</source>
      <translation>ARRIBA</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>%1 Hz</source>
      <translation>%1 Hz</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>A DRIVE TEST HAS NO RAPID: PRESS WITHOUT SHIFT</source>
      <translation>UNA PRUEBA DE ACCIONAMIENTO NO TIENE RÁPIDO: PULSE SIN MAYÚS</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>AN ARROW ASKS FOR THE TRAVEL; THE SAME ARROW, HELD, PLAYS THE TEST; F5 SHOWS ITS FIGURES</source>
      <translation>UNA FLECHA PREGUNTA POR EL RECORRIDO; LA MISMA, MANTENIDA, HACE LA PRUEBA; F5 MUESTRA SUS CIFRAS</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>ANOTHER TEST WAS CHOSEN: THE ONE UNDER WAY HAS ENDED</source>
      <translation>SE ELIGIÓ OTRA PRUEBA: LA QUE ESTABA EN CURSO HA TERMINADO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>CHOSEN</source>
      <translation>ELEGIDO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>DRIVE TEST</source>
      <translation>PRUEBA DE ACCIONAMIENTO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>HERTZ</source>
      <translation>HERCIOS</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>KEEP IT HELD UNTIL IT HAS COME BACK</source>
      <translation>MANTÉNGALA PULSADA HASTA QUE HAYA VUELTO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>KEY</source>
      <translation>TECLA</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>NO DRIVE TEST: {why}</source>
      <translation>SIN PRUEBA DE ACCIONAMIENTO: {why}</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>Nothing is written to a drive.</source>
      <translation>No se escribe nada en un accionamiento.</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>Of the slide: a size of X is half of a diameter.</source>
      <translation>Del carro: un tamaño en X es la mitad de un diámetro.</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>RAMP</source>
      <translation>RAMPA</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>SHAPE</source>
      <translation>FORMA</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>SINE</source>
      <translation>SENO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>SIZE</source>
      <translation>TAMAÑO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>STEP</source>
      <translation>PASO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>THE SPINDLE TURNS: STOP IT FIRST</source>
      <translation>EL HUSILLO GIRA: PÁRELO ANTES</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>THE TEST HAS ENDED: THE KEYBOARD WENT ELSEWHERE</source>
      <translation>LA PRUEBA HA TERMINADO: EL TECLADO SE FUE A OTRA PARTE</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>WINDOW {axis}</source>
      <translation>VENTANA {axis}</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>WRITTEN: {path}</source>
      <translation>ESCRITO: {path}</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>as fast as it can</source>
      <translation>lo más rápido que puede</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>drive test %1 %2</source>
      <translation>prueba de accionamiento %1 %2</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>no test has been played yet</source>
      <translation>aún no se ha hecho ninguna prueba</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>{axis} FROM {here} TO {there} AND BACK, {seconds} S</source>
      <translation>{axis} DE {here} A {there} Y VUELTA, {seconds} S</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>{axis} HAS NO ROOM FOR IT: JOG AWAY FROM THE END OF ITS TRAVEL</source>
      <translation>{axis} NO TIENE SITIO PARA ELLO: ALÉJELO A MANO DEL FINAL DE SU RECORRIDO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>{axis} IS NOT HOMED: NOBODY KNOWS WHETHER THE TEST HAS ROOM</source>
      <translation>{axis} NO ESTÁ REFERENCIADO: NADIE SABE SI LA PRUEBA TIENE SITIO</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_model.py" />
      <source>{travel}: HOLD {key} TO PLAY IT, LET GO TO STOP</source>
      <translation>{travel}: MANTENGA {key} PARA HACERLA, SUELTE PARA PARAR</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_view.py" />
      <source>ANALYSE</source>
      <translation>ANALIZAR</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_view.py" />
      <source>DRIVE TEST  ·  ASK, THEN HOLD</source>
      <translation>PRUEBA  ·  PREGUNTAR, LUEGO MANTENER</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_view.py" />
      <source>FIGURES</source>
      <translation>VALORES</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_view.py" />
      <source>HOLD {way}</source>
      <translation>MANTENGA {way}</translation>
    </message>
    <message>
      <location filename="app/jog/drive_test_view.py" />
      <source>JOG</source>
      <translation>MANUAL</translation>
    </message>
    <message>
      <location filename="app/jog/held_jog.py" />
      <source>ANOTHER KEY HAS ENDED THE JOG</source>
      <translation>OTRA TECLA TERMINÓ EL MOVIMIENTO</translation>
    </message>
    <message>
      <location filename="app/jog/held_jog.py" />
      <source>RAPID IS FOR A HELD JOG: CHOOSE CONTINUOUS, OR PRESS WITHOUT SHIFT</source>
      <translation>EL RÁPIDO ES PARA MOVER SOSTENIENDO: ELIJA CONTINUO, U OPRIMA SIN SHIFT</translation>
    </message>
    <message>
      <location filename="app/jog/held_jog.py" />
      <source>SHIFT WAS LET GO: THE RAPID HAS ENDED</source>
      <translation>SE SOLTÓ SHIFT: TERMINÓ EL RÁPIDO</translation>
    </message>
    <message>
      <location filename="app/jog/held_jog.py" />
      <source>THE KEY HAS GONE SILENT: LET IT GO AND PRESS IT AGAIN</source>
      <translation>LA TECLA DEJÓ DE RESPONDER: SUÉLTELA Y OPRÍMALA DE NUEVO</translation>
    </message>
    <message>
      <location filename="app/jog/held_jog.py" />
      <source>THE SCREEN WAS AWAY: THE JOG HAS ENDED</source>
      <translation>LA PANTALLA ESTUVO AUSENTE: TERMINÓ EL MOVIMIENTO</translation>
    </message>
    <message>
      <location filename="app/jog/held_jog.py" />
      <source>TWO AT ONCE MOVE NOTHING: LET BOTH GO, THEN PRESS ONE</source>
      <translation>DOS A LA VEZ NO MUEVEN NADA: SUELTE LAS DOS Y OPRIMA UNA</translation>
    </message>
    <message>
      <location filename="app/jog/held_keys_view.py" />
      <source>NUM LOCK IS OFF: THE ARROWS OF THE NUMBER PAD MOVE NOTHING</source>
      <translation>BLOQ NUM ESTÁ DESACTIVADO: LAS FLECHAS DEL TECLADO NUMÉRICO NO MUEVEN NADA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_handwheel.py" />
      <source>THE HANDWHEEL IS OFF: {why}</source>
      <translation>EL VOLANTE ESTÁ DESCONECTADO: {why}</translation>
    </message>
    <message>
      <location filename="app/jog/jog_handwheel.py" />
      <source>THE SCREEN WAS AWAY: THE HANDWHEEL IS OFF</source>
      <translation>LA PANTALLA ESTUVO AUSENTE: EL VOLANTE ESTÁ DESCONECTADO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_handwheel.py" />
      <source>THE SWITCH AT THE STATION CHOOSES THE AXIS OF THE HANDWHEEL</source>
      <translation>EL INTERRUPTOR DE LA ESTACIÓN ELIGE EL EJE DEL VOLANTE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_handwheel.py" />
      <source>THIS MACHINE HAS NO HANDWHEEL</source>
      <translation>ESTA MÁQUINA NO TIENE VOLANTE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source> OR </source>
      <translation> O </translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>, THEN </source>
      <translation>, LUEGO </translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>ABSOLUTE</source>
      <translation>ABSOLUTO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>EVERY AXIS KNOWS ITS POSITION: THERE IS NOTHING TO HOME</source>
      <translation>TODOS LOS EJES CONOCEN SU POSICIÓN: NO HAY NADA QUE REFERENCIAR</translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>HOME {first}: PRESS RETURN FOR ALL, {letters} FOR ONE AXIS, ESC FOR NONE</source>
      <translation>REFERENCIAR {first}: OPRIMA RETURN PARA TODOS, {letters} PARA UN EJE, ESC PARA NINGUNO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>HOMED</source>
      <translation>CON REF</translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>HOMING</source>
      <translation>BUSCANDO REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>NOT HOMED</source>
      <translation>SIN REF</translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>T{tool} MAY STAND IN THE PART: JOG IT CLEAR FIRST. </source>
      <translation>T{tool} PUEDE ESTAR EN LA PIEZA: PRIMERO SÁQUELA A MANO. </translation>
    </message>
    <message>
      <location filename="app/jog/jog_homing.py" />
      <source>{axis} KNOWS ITS POSITION</source>
      <translation>{axis} CONOCE SU POSICIÓN</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source> AND </source>
      <translation> Y </translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>A PROGRAM IS UNDER WAY: LET IT END, OR GIVE IT UP WITH R, BEFORE JOGGING</source>
      <translation>HAY UN PROGRAMA EN CURSO: DEJE QUE TERMINE, O ABANDÓNELO CON R, ANTES DE MOVER A MANO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>AN ALARM STANDS: PUT ITS CAUSE RIGHT, THEN PRESS R</source>
      <translation>HAY UNA ALARMA: CORRIJA SU CAUSA Y OPRIMA R</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>AN ENTRY IS OPEN: PRESS RETURN OR ESC FIRST</source>
      <translation>HAY UNA ENTRADA ABIERTA: OPRIMA PRIMERO RETURN O ESC</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>AN ENTRY IS OPEN: PRESS RETURN OR ESC; THE ARROWS MOVE NOTHING MEANWHILE</source>
      <translation>HAY UNA ENTRADA ABIERTA: OPRIMA RETURN O ESC; MIENTRAS TANTO LAS FLECHAS NO MUEVEN NADA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>AN ENTRY IS OPEN: THE HANDWHEEL IS OFF</source>
      <translation>HAY UNA ENTRADA ABIERTA: EL VOLANTE ESTÁ DESCONECTADO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>ANOTHER SPEED WAS CHOSEN: THE JOG HAS ENDED</source>
      <translation>SE ELIGIÓ OTRA VELOCIDAD: TERMINÓ EL MOVIMIENTO A MANO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>ANOTHER STEP WAS CHOSEN: THE JOG HAS ENDED</source>
      <translation>SE ELIGIÓ OTRO PASO: TERMINÓ EL MOVIMIENTO A MANO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>EACH PRESS OF AN ARROW IS ONE STEP; F2 CHANGES ITS LENGTH</source>
      <translation>CADA OPRESIÓN DE UNA FLECHA ES UN PASO; F2 CAMBIA SU TAMAÑO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>HOLD AN ARROW TO MOVE, WITH SHIFT FOR RAPID; T CHOOSES A TOOL, X AND Z TOUCH IT OFF</source>
      <translation>SOSTENGA UNA FLECHA PARA MOVER, CON SHIFT PARA RÁPIDO; T ELIGE HERRAMIENTA, X o Z LA TOCAN</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>HOMING IS NOT DONE; PRESS THE ARROW AGAIN TO JOG</source>
      <translation>LA REFERENCIA NO ESTÁ HECHA; OPRIMA OTRA VEZ LA FLECHA PARA MOVER</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>ON A MILL THE OFFSET IS THE LENGTH OF THE TOOL: MEASURE IT, AND TYPE IT ON F8</source>
      <translation>EN UNA FRESADORA LA COMPENSACIÓN ES EL LARGO DE LA HERRAMIENTA: MÍDALO, Y ESCRÍBALO EN F8</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>RETURN KEEPS WHAT WAS FOUND, ESC LEAVES THE TOOL AS IT WAS</source>
      <translation>INTRO GUARDA LO HALLADO, ESC DEJA LA HERRAMIENTA COMO ESTABA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>THE DRIVES ARE OFF: PRESS D FOR DRIVES ON</source>
      <translation>LOS SERVOS ESTÁN APAGADOS: OPRIMA D PARA ENCENDERLOS</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>THE E-STOP IS PRESSED: NOTHING MOVES</source>
      <translation>EL PARO DE EMERGENCIA ESTÁ OPRIMIDO: NADA SE MUEVE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>THE HANDWHEEL IS OFF</source>
      <translation>EL VOLANTE ESTÁ DESCONECTADO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>THE HANDWHEEL IS OFF: THE KEYBOARD WENT ELSEWHERE</source>
      <translation>EL VOLANTE ESTÁ DESCONECTADO: EL TECLADO SE FUE A OTRA PARTE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>THE HANDWHEEL MOVES {axis}: ONE CLICK IS ONE STEP; V FOR THE NEXT AXIS</source>
      <translation>EL VOLANTE MUEVE {axis}: UN CLIC ES UN PASO; V PARA EL EJE SIGUIENTE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>THE JOG HAS ENDED: THE KEYBOARD WENT ELSEWHERE</source>
      <translation>TERMINÓ EL MOVIMIENTO A MANO: EL TECLADO PASÓ A OTRA PARTE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>THE SLIDES ARE LOOKING FOR HOME: H STOPS THEM</source>
      <translation>LOS CARROS BUSCAN SU REFERENCIA: H LOS DETIENE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>THE SLIDES ARE STILL MOVING</source>
      <translation>LOS CARROS TODAVÍA SE MUEVEN</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>TYPE A VALUE OR A SUM SUCH AS .5-.002, THEN RETURN; ESC LEAVES IT AS IT WAS</source>
      <translation>ESCRIBA UN VALOR O UNA SUMA COMO .5-.002 Y RETURN; ESC LO DEJA COMO ESTABA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_model.py" />
      <source>{axes} NOT HOMED: JOG SLOWLY, THERE ARE NO SOFT LIMITS; PRESS HOME</source>
      <translation>{axes} SIN REFERENCIA: MUEVA DESPACIO, NO HAY LÍMITES POR PROGRAMA; OPRIMA REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>CONT</source>
      <translation>CONT</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>HELD</source>
      <translation>SOSTENIDO</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>HOME</source>
      <translation>REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>IN/MIN</source>
      <translation>PULG/MIN</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>JOG  ·  HOLD TO MOVE</source>
      <translation>MANUAL  ·  SOSTENGA PARA MOVER</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>MM/MIN</source>
      <translation>MM/MIN</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>SETTER P</source>
      <translation>PALPADOR P</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>STEP IN</source>
      <translation>PASO PLG</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>STEP MM</source>
      <translation>PASO MM</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>TOUCH OFF</source>
      <translation>TOQUE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>WHEEL</source>
      <translation>VOLANTE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>WHEEL {axis}</source>
      <translation>VOLANTE {axis}</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>at the setter</source>
      <translation>en el palpador</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>in</source>
      <translation>pulg</translation>
    </message>
    <message>
      <location filename="app/jog/jog_pad_view.py" />
      <source>mm</source>
      <translation>mm</translation>
    </message>
    <message>
      <location filename="app/jog/jog_touch_off.py" />
      <source>, alone</source>
      <translation>, sola</translation>
    </message>
    <message>
      <location filename="app/jog/jog_touch_off.py" />
      <source>TOUCH OFF WITH THE MACHINE AT REST AND READY</source>
      <translation>TOQUE LA HERRAMIENTA CON LA MÁQUINA EN REPOSO Y LISTA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_touch_off.py" />
      <source>touched Z</source>
      <translation>tocada en Z</translation>
    </message>
    <message>
      <location filename="app/jog/jog_touch_off.py" />
      <source>touched off, new tool</source>
      <translation>tocada, herramienta nueva</translation>
    </message>
    <message>
      <location filename="app/jog/jog_touch_off.py" />
      <source>touched Ø</source>
      <translation>tocada en Ø</translation>
    </message>
    <message>
      <location filename="app/jog/jog_touch_off.py" />
      <source>{axis} IS NOT HOMED: ITS POSITION MEANS NOTHING YET</source>
      <translation>{axis} NO TIENE REFERENCIA: SU POSICIÓN AÚN NO VALE</translation>
    </message>
    <message>
      <location filename="app/jog/jog_touch_off.py" />
      <source>{axis} would be out of range</source>
      <translation>{axis} quedaría fuera de alcance</translation>
    </message>
    <message>
      <location filename="app/jog/jog_view.py" />
      <source>ALONE</source>
      <translation>SOLA</translation>
    </message>
    <message>
      <location filename="app/jog/jog_view.py" />
      <source>Return enters it, Esc leaves it as it was</source>
      <translation>Return lo pone, Esc lo deja como estaba</translation>
    </message>
    <message>
      <location filename="app/jog/jog_view.py" />
      <source>T tool · X Z touch · W wear · N nose · Q tip · K remark · M master · F10 undo</source>
      <translation>T herr · X Z tocar · W desgaste · N punta · Q cuadrante · K nota · M maestra · F10 deshacer</translation>
    </message>
    <message>
      <location filename="app/jog/pendant_jog.py" />
      <source>THE ENABLING SWITCH IS NOT HELD: THE BUTTON MOVES NOTHING</source>
      <translation>EL INTERRUPTOR DE VALIDACIÓN NO ESTÁ PULSADO: EL BOTÓN NO MUEVE NADA</translation>
    </message>
    <message>
      <location filename="app/jog/pendant_jog.py" />
      <source>THE SCREEN WAS AWAY: LET THE BUTTON GO, AND PRESS IT AGAIN</source>
      <translation>LA PANTALLA ESTUVO AUSENTE: SUELTE EL BOTÓN Y PÚLSELO OTRA VEZ</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>A TOUCH-OFF HAS NO RAPID: PRESS WITHOUT SHIFT</source>
      <translation>UN TOQUE NO TIENE RÁPIDO: PULSE SIN MAYÚS</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>LOOKING FOR THE TOOL SETTER: LETTING GO STOPS</source>
      <translation>BUSCANDO EL PALPADOR: AL SOLTAR SE DETIENE</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>NOT TOUCHED OFF: {why}</source>
      <translation>NO SE HA TOCADO: {why}</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>NOTHING THERE: GOING BACK</source>
      <translation>NO HAY NADA: VOLVIENDO</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>THIS MACHINE HAS NO TOOL SETTER</source>
      <translation>ESTA MÁQUINA NO TIENE PALPADOR DE HERRAMIENTAS</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>TOUCHED: BACKING OFF</source>
      <translation>TOCADO: RETROCEDIENDO</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>TOUCHING SLOWLY: THIS ONE COUNTS</source>
      <translation>TOCANDO DESPACIO: ESTE TOQUE CUENTA</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>T{number} AT THE TOOL SETTER: HOLD {keys} UNTIL IT IS BACK; P OR ESC ENDS</source>
      <translation>T{number} EN EL PALPADOR: MANTENGA {keys} HASTA QUE VUELVA; P O ESC TERMINA</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>T{number} HAS NO TIP: PRESS Q AND TYPE 1…9, WHICH WAY IT POINTS</source>
      <translation>T{number} NO TIENE PUNTA: PULSE Q Y ESCRIBA 1…9, HACIA DÓNDE APUNTA</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>T{number} TOUCHES WITH {ways} ALONE</source>
      <translation>T{number} SOLO TOCA CON {ways}</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>WHICH TOOL? PRESS T AND TYPE ITS NUMBER FIRST</source>
      <translation>¿CUÁL HERRAMIENTA? OPRIMA T Y ESCRIBA PRIMERO SU NÚMERO</translation>
    </message>
    <message>
      <location filename="app/jog/setter_touch.py" />
      <source>tool setter {way} ±{error}</source>
      <translation>palpador {way} ±{error}</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>DIFFERENCE</source>
      <translation>DIFERENCIA</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>REFUSED: {why}</source>
      <translation>RECHAZADO: {why}</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>THE CONTROL HAS CHANGED ITS UNIT OR ITS X: NOTHING WAS CHANGED, ENTER IT AGAIN</source>
      <translation>EL CONTROL CAMBIÓ SU UNIDAD O SU X: NO SE CAMBIÓ NADA, ESCRÍBALO OTRA VEZ</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>THE SLIDE HAS MOVED SINCE: PRESS ESC AND TOUCH AGAIN</source>
      <translation>EL CARRO SE MOVIÓ DESPUÉS: OPRIMA ESC Y TOQUE OTRA VEZ</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>TOOL NUMBER?</source>
      <translation>¿NÚMERO DE HERRAMIENTA?</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>T{number:g} does not exist; tools are T1…32</source>
      <translation>T{number:g} no existe; las herramientas son T1…32</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>T{number} ALONE: THE OTHERS STAY (L: ALL FOLLOW)</source>
      <translation>T{number} SOLA: LAS DEMÁS QUEDAN (L: TODAS LA SIGUEN)</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>T{number} IS AS IT WAS</source>
      <translation>T{number} QUEDA COMO ESTABA</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>T{number} IS SET WHEN {axis} IS TOUCHED TOO</source>
      <translation>T{number} QUEDA PUESTA CUANDO TAMBIÉN SE TOQUE {axis}</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>T{number} IS THE MASTER: ALL TOOLS FOLLOW (L: IT ALONE)</source>
      <translation>T{number} ES LA MAESTRA: TODAS LAS HERRAMIENTAS LA SIGUEN (L: SÓLO ELLA)</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>T{number} WAS NEVER SET: TOUCH X AND Z FIRST</source>
      <translation>T{number} NUNCA SE PUSO: TOQUE PRIMERO X Y Z</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>{tool} MEASURED DIAMETER?</source>
      <translation>¿DIÁMETRO MEDIDO DE {tool}?</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>{tool} Z POSITION OF THE FACE?</source>
      <translation>¿POSICIÓN Z DE LA CARA PARA {tool}?</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting.py" />
      <source>{tool} {axis} BY THE TOOL SETTER: KEEP IT?</source>
      <translation>{tool} {axis} SEGÚN EL PALPADOR: ¿GUARDAR?</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting_view.py" />
      <source>ITS TIP IS NOW AT</source>
      <translation>SU PUNTA ESTÁ AHORA EN</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting_view.py" />
      <source>THIS ONE</source>
      <translation>ÉSTA</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting_view.py" />
      <source>TOOL SETTING</source>
      <translation>AJUSTE DE HERRAMIENTA</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting_view.py" />
      <source>TOUCH X</source>
      <translation>TOCAR X</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting_view.py" />
      <source>TOUCH Z</source>
      <translation>TOCAR Z</translation>
    </message>
    <message>
      <location filename="app/jog/tool_setting_view.py" />
      <source>none</source>
      <translation>ninguna</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>A LINE IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R</source>
      <translation>HAY UNA LÍNEA EN CURSO: DEJE QUE TERMINE, O PÁRELA Y OPRIMA R</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>A PROGRAM IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R, BEFORE MDI</source>
      <translation>HAY UN PROGRAMA EN CURSO: DEJE QUE TERMINE, O PÁRELO Y OPRIMA R, ANTES DE MDI</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>DRIVES ARE OFF: PRESS F5 FOR DRIVES ON; A LINE CAN BE TYPED MEANWHILE</source>
      <translation>SERVOS APAGADOS: OPRIMA F5 PARA ENCENDERLOS; MIENTRAS TANTO SE PUEDE ESCRIBIR UNA LÍNEA</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>NO LINE IS READY: TYPE ONE AND PRESS ENTER</source>
      <translation>NO HAY LÍNEA LISTA: ESCRIBA UNA Y OPRIMA ENTER</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>PROVING THE LINE</source>
      <translation>COMPROBANDO LA LÍNEA</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>Set it with F8.</source>
      <translation>Póngala con F8.</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>THE LINE CANNOT BE PROVED: {why}</source>
      <translation>LA LÍNEA NO SE PUEDE COMPROBAR: {why}</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>THE LINE DOES NOT RUN: MEND IT, OR ESC TO CLEAR IT</source>
      <translation>LA LÍNEA NO CORRE: CORRÍJALA, O ESC PARA BORRARLA</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>THE LINE IS PROVED AND RUN WITH THE DRIVES ON: F5 SWITCHES THEM ON, F6 IS RESET</source>
      <translation>LA LÍNEA SE COMPRUEBA Y CORRE CON SERVOS ENCENDIDOS: F5 LOS ENCIENDE, F6 ES RESET</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>TO RUN THE LINE {start}; ESC TAKES IT BACK</source>
      <translation>PARA CORRER LA LÍNEA {start}; ESC LA RETIRA</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>TYPE A LINE FIRST; ARROW UP BRINGS EARLIER ONES BACK</source>
      <translation>ESCRIBA PRIMERO UNA LÍNEA; LA FLECHA ARRIBA TRAE LAS ANTERIORES</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>TYPE A LINE, ENTER PROVES IT; F1 LEAVES, THE SPINDLE STAYS AS IT IS</source>
      <translation>ESCRIBA UNA LÍNEA, ENTER LA COMPRUEBA; F1 SALE, EL HUSILLO QUEDA COMO ESTÁ</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_model.py" />
      <source>Tool {number} was never set.</source>
      <translation>La herramienta {number} nunca se puso.</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>AUTO</source>
      <translation>AUTO</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>DRIVES</source>
      <translation>SERVOS</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>HISTORY  ·  ARROW UP AND DOWN</source>
      <translation>HISTORIA  ·  FLECHA ARRIBA Y ABAJO</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>IN FORCE</source>
      <translation>VIGENTE</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>LINE</source>
      <translation>LÍNEA</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>LINE  ·  READY, CYCLE START RUNS IT</source>
      <translation>LÍNEA  ·  LISTA, INICIO DE CICLO LA CORRE</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>No line was run yet.</source>
      <translation>Todavía no se corre ninguna línea.</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>RESET</source>
      <translation>RESET</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>SCOPE</source>
      <translation>OSCILO</translation>
    </message>
    <message>
      <location filename="app/mdi/mdi_view.py" />
      <source>SPN STOP</source>
      <translation>PARO HUS</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_book.py" />
      <source>NO OFFSETS ARE KEPT HERE</source>
      <translation>AQUÍ NO SE GUARDAN COMPENSACIONES</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_book.py" />
      <source>OFFSETS CANNOT BE KEPT: %1</source>
      <translation>NO SE PUEDEN GUARDAR LAS COMPENSACIONES: %1</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_book.py" />
      <source>STILL SAVING THE CHANGE BEFORE: PRESS RETURN AGAIN</source>
      <translation>EL CAMBIO ANTERIOR TODAVÍA SE ESTÁ GUARDANDO: OPRIMA RETURN OTRA VEZ</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>DRAWING THE PATH BEFORE AND AFTER</source>
      <translation>DIBUJANDO LA TRAYECTORIA ANTES Y DESPUÉS</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>LOAD A PROGRAM FIRST: THE EFFECT IS SHOWN ON ITS PATH</source>
      <translation>CARGUE PRIMERO UN PROGRAMA: EL EFECTO SE VE SOBRE SU TRAYECTORIA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>MAKING THE PART WITH THE OFFSETS BEFORE AND AFTER</source>
      <translation>HACIENDO LA PIEZA CON LOS CORRECTORES DE ANTES Y DESPUÉS</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>NO DIAMETER OR SHOULDER OF THE PART CHANGES; F6 SHOWS THE TABLE</source>
      <translation>NO CAMBIA NINGÚN DIÁMETRO NI HOMBRO DE LA PIEZA; F6 MUESTRA LA TABLA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>NOTHING HAS CHANGED HERE YET: TYPE A VALUE OR CHANGE ONE, THEN PRESS F6</source>
      <translation>AQUÍ AÚN NO CAMBIÓ NADA: ESCRIBA UN VALOR O CAMBIE UNO, Y OPRIMA F6</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>THE EFFECT CANNOT BE DRAWN: {why}</source>
      <translation>EL EFECTO NO SE PUEDE DIBUJAR: {why}</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>THE PART CANNOT BE COMPARED: {why}; F6 SHOWS THE TABLE</source>
      <translation>LA PIEZA NO SE PUEDE COMPARAR: {why}; F6 MUESTRA LA TABLA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>THE PATHS DIFFER IN KIND; F6 SHOWS THE TABLE</source>
      <translation>LAS TRAYECTORIAS DIFIEREN EN CLASE; F6 MUESTRA LA TABLA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>THIS CHANGE DOES NOTHING TO THE LOADED PROGRAM; F6 SHOWS THE TABLE</source>
      <translation>ESTE CAMBIO NO HACE NADA EN EL PROGRAMA CARGADO; F6 MUESTRA LA TABLA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>THIS PROGRAM MAKES NO PART</source>
      <translation>ESTE PROGRAMA NO HACE PIEZA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>UP TO {far} APART, AT THE CIRCLE; F6 GOES NEAR, Z ZOOMS, ESC SHOWS THE TABLE</source>
      <translation>HASTA {far} DE DIFERENCIA, EN EL CÍRCULO; F6 SE ACERCA, Z AMPLÍA, ESC MUESTRA LA TABLA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>UP TO {far} APART; Z ZOOMS, F6 SHOWS THE TABLE</source>
      <translation>HASTA {far} DE DIFERENCIA; Z AMPLÍA, F6 MUESTRA LA TABLA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>UP TO {far} APART; Z ZOOMS, F6: WHAT IT DOES TO THE PART</source>
      <translation>HASTA {far} DE SEPARACIÓN; Z AMPLÍA, F6: QUÉ HACE A LA PIEZA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_effect.py" />
      <source>{count} FEATURES OF THE PART CHANGE; F6 SHOWS THE TABLE</source>
      <translation>CAMBIAN {count} MEDIDAS DE LA PIEZA; F6 MUESTRA LA TABLA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>; IT COUNTS FROM THE NEXT CYCLE START</source>
      <translation>; CUENTA DESDE EL PRÓXIMO INICIO DE CICLO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>; IT COUNTS FROM THE NEXT PART</source>
      <translation>; CUENTA DESDE LA PRÓXIMA PIEZA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>A PROGRAM IS UNDER WAY: ONLY WEAR AND F9 CORRECTIONS MAY CHANGE</source>
      <translation>HAY UN PROGRAMA EN MARCHA: SÓLO EL DESGASTE Y LAS CORRECCIONES DE F9 PUEDEN CAMBIAR</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>PARTS RUN: A CORRECTION COUNTS FROM THE NEXT PART, ONCE IT IS PROVED</source>
      <translation>HAY PIEZAS EN MARCHA: UNA CORRECCIÓN CUENTA DESDE LA PRÓXIMA PIEZA, UNA VEZ COMPROBADA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>SAVED</source>
      <translation>GUARDADO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>THE PART UNDER WAY KEEPS ITS OFFSETS: A CORRECTION COUNTS FROM THE NEXT CYCLE START</source>
      <translation>LA PIEZA EN MARCHA CONSERVA SUS COMPENSACIONES: UNA CORRECCIÓN CUENTA DESDE EL PRÓXIMO ARRANQUE DE CICLO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>THE SLIDES ARE MOVING: OFFSETS CHANGE AT REST</source>
      <translation>LOS CARROS SE MUEVEN: LAS COMPENSACIONES CAMBIAN EN REPOSO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>{count} OFFSETS</source>
      <translation>{count} COMPENSACIONES</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>{count} offsets changed: F5 shows them</source>
      <translation>cambiaron {count} compensaciones: F5 las muestra</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>{names} SAVED</source>
      <translation>{names} GUARDADAS</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_history.py" />
      <source>{names} TAKEN BACK</source>
      <translation>{names} RETIRADAS</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_table.py" />
      <source>F5 OR ESC LEAVES THE HISTORY; PAGE UP AND PAGE DOWN LOOK ON</source>
      <translation>F5 O ESC DEJA LA HISTORIA; RE PÁG Y AV PÁG SIGUEN VIENDO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>BORING</source>
      <translation>MANDRINADO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>CENTRE DRILL</source>
      <translation>BROCA DE CENTRAR</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>CUTTING LENGTH</source>
      <translation>LONGITUD DE CORTE</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>DIAMETER</source>
      <translation>DIÁMETRO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>DRILL</source>
      <translation>BROCA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>END MILL</source>
      <translation>FRESA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>ENTERING ANGLE</source>
      <translation>ÁNGULO DE POSICIÓN</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>FLUTES</source>
      <translation>FILOS</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>FORM TOOL</source>
      <translation>HERRAMIENTA DE FORMA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>GROOVING</source>
      <translation>RANURADO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>HAND</source>
      <translation>MANO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>HOLDER</source>
      <translation>PORTAHERRAMIENTA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>INSERT</source>
      <translation>INSERTO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>KIND</source>
      <translation>CLASE</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>LEFT HAND</source>
      <translation>A IZQUIERDAS</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>MASTER</source>
      <translation>MAESTRA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>NEUTRAL</source>
      <translation>NEUTRO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>NO</source>
      <translation>NO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>NOSE RADIUS</source>
      <translation>RADIO PUNTA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>PARTING</source>
      <translation>TRONZADO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>PITCH</source>
      <translation>PASO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>POINT ANGLE</source>
      <translation>ÁNGULO DE PUNTA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>PROFILE</source>
      <translation>PERFIL</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>REAMER</source>
      <translation>ESCARIADOR</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>REMARK</source>
      <translation>NOTA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>RIGHT HAND</source>
      <translation>A DERECHAS</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>STICK-OUT</source>
      <translation>VOLADIZO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>TAP</source>
      <translation>MACHO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>THREADING</source>
      <translation>ROSCADO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>TIP</source>
      <translation>PUNTA</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>TURNING</source>
      <translation>CILINDRADO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>WEAR</source>
      <translation>DESGASTE</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>WEAR X</source>
      <translation>DESGASTE X</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>WEAR Z</source>
      <translation>DESGASTE Z</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>WIDTH</source>
      <translation>ANCHO</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>WORKS AT X−</source>
      <translation>TRABAJA EN X−</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>X</source>
      <translation>X</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>YES</source>
      <translation>SÍ</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>Z</source>
      <translation>Z</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>no</source>
      <translation>no</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>not set</source>
      <translation>sin poner</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>yes</source>
      <translation>sí</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>{field} takes no sum; press Return to set it</source>
      <translation>{field} no acepta sumas; oprima Return para ponerlo</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>{field} takes {range}</source>
      <translation>{field} acepta {range}</translation>
    </message>
    <message>
      <location filename="app/offsets/offset_values.py" />
      <source>{field} would become {value} {unit}; it may be {low}…{high}</source>
      <translation>{field} quedaría en {value} {unit}; puede ser {low}…{high}</translation>
    </message>
    <message>
      <location filename="app/offsets/offsets_view.py" />
      <source>HISTORY  ·  NEWEST ON TOP</source>
      <translation>HISTORIA  ·  LO NUEVO ARRIBA</translation>
    </message>
    <message>
      <location filename="app/offsets/offsets_view.py" />
      <source>No offset was changed yet.</source>
      <translation>Todavía no se cambia ninguna compensación.</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>AFTER</source>
      <translation>DESPUÉS</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>BORE</source>
      <translation>AGUJERO</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>FEATURE</source>
      <translation>MEDIDA</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>LINE {line}: {check} IS GONE</source>
      <translation>LÍNEA {line}: YA NO HAY {check}</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>LINE {line}: {what}</source>
      <translation>LÍNEA {line}: {what}</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>NOT BOTH</source>
      <translation>SOLO UNA</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>SHOULDER</source>
      <translation>HOMBRO</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>SHOULDER IN THE BORE</source>
      <translation>HOMBRO DEL AGUJERO</translation>
    </message>
    <message>
      <location filename="app/offsets/part_effect.py" />
      <source>WHAT IT DOES TO THE PART</source>
      <translation>QUÉ HACE A LA PIEZA</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>C CLEARS ALL OFFSETS ONLY WHILE Offset Number? IS ASKED; PRESS ESC FIRST</source>
      <translation>C BORRA TODO SÓLO MIENTRAS SE PREGUNTA ¿Número de compensación?; OPRIMA PRIMERO ESC</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>C: all offsets cleared</source>
      <translation>C: todas las compensaciones a cero</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>D{number:g} does not exist; offsets are D1…32</source>
      <translation>D{number:g} no existe; las compensaciones son D1…32</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>D{number} IS AS IT WAS</source>
      <translation>D{number} QUEDA COMO ESTABA</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>EVERY VALUE TAKES ARITHMETIC, SUCH AS .5-.002; RETURN ALONE KEEPS THE VALUE</source>
      <translation>TODO VALOR ACEPTA OPERACIONES, COMO .5-.002; RETURN SOLO CONSERVA EL VALOR</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>FINISH D{number} FIRST, OR PRESS ESC</source>
      <translation>TERMINE PRIMERO D{number}, U OPRIMA ESC</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>Offset Number?</source>
      <translation>¿Número de compensación?</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>PRESS Y TO CLEAR ALL 32 SECONDARY OFFSETS, ESC TO KEEP THEM</source>
      <translation>OPRIMA Y PARA BORRAR LAS 32 COMPENSACIONES SECUNDARIAS, ESC PARA CONSERVARLAS</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>Press C to clear all offsets</source>
      <translation>Oprima C para borrar todas las compensaciones</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>Press Esc to exit offset adjustment screen</source>
      <translation>Oprima Esc para salir del ajuste de compensaciones</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>R?</source>
      <translation>¿R?</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>Secondary offset number:</source>
      <translation>Número de compensación secundaria:</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>THE CONTROL HAS CHANGED ITS UNIT: NOTHING WAS CHANGED, ENTER IT AGAIN</source>
      <translation>EL CONTROL HA CAMBIADO SU UNIDAD: NO SE CAMBIÓ NADA, INTRODÚZCALO OTRA VEZ</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>X DIAMETER CORRECTION?</source>
      <translation>¿CORRECCIÓN EN DIÁMETRO X?</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets.py" />
      <source>Z CORRECTION?</source>
      <translation>¿CORRECCIÓN Z?</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets_view.py" />
      <source>ALL 32 OFFSETS</source>
      <translation>LAS 32 COMPENSACIONES</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets_view.py" />
      <source>EFFECT</source>
      <translation>EFECTO</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets_view.py" />
      <source>SECONDARY OFFSETS  ·  X STORED AS A RADIUS</source>
      <translation>COMPENSACIONES SECUNDARIAS  ·  X SE GUARDA COMO RADIO</translation>
    </message>
    <message>
      <location filename="app/offsets/secondary_offsets_view.py" />
      <source>ZERO</source>
      <translation>CEROS</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_fields.py" />
      <source>NOW {axis}: T{number} IS SET WHEN BOTH ARE THERE</source>
      <translation>AHORA {axis}: T{number} QUEDA PUESTA CUANDO ESTÉN LAS DOS</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_fields.py" />
      <source>PRESS RETURN TO SET IT, OR ESC TO LEAVE IT AS IT WAS</source>
      <translation>OPRIMA RETURN PARA PONERLO, O ESC PARA DEJARLO COMO ESTABA</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_fields.py" />
      <source>T{number} WAS NEVER SET: TYPE X AND Z FIRST, OR TOUCH IT OFF ON THE JOG PAGE</source>
      <translation>T{number} NUNCA SE PUSO: ESCRIBA PRIMERO X Y Z, O TÓQUELA EN LA PÁGINA MANUAL</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_fields.py" />
      <source>chosen as master</source>
      <translation>elegida como maestra</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_fields.py" />
      <source>entered by hand</source>
      <translation>escrito a mano</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_fields.py" />
      <source>no master</source>
      <translation>sin maestra</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets.py" />
      <source>ARROWS CHOOSE A CELL; TYPE A VALUE OR A SUM; RETURN SETS IT, F2 ADDS IT TO WHAT IS THERE</source>
      <translation>LAS FLECHAS ELIGEN CELDA; ESCRIBA UN VALOR O UNA SUMA; RETURN LO PONE, F2 LO SUMA A LO QUE HAY</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets.py" />
      <source>F2 adds what is typed; F3 shows X and Z from the master; F8: shape of the tool; Esc leaves</source>
      <translation>F2 suma lo escrito; F3 muestra X y Z desde la maestra; F8: forma de la herramienta; Esc sale</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets.py" />
      <source>NO TOOL IS THE MASTER: CHOOSE ONE IN ITS COLUMN WITH RETURN</source>
      <translation>NINGUNA HERRAMIENTA ES LA MAESTRA: ELIJA UNA EN SU COLUMNA CON RETURN</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets.py" />
      <source>PRESS RETURN TO WRITE A REMARK</source>
      <translation>OPRIMA RETURN PARA ESCRIBIR UNA NOTA</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets.py" />
      <source>TYPE THE REMARK; RETURN KEEPS IT, ESC LEAVES IT AS IT WAS; F-KEYS STILL WORK</source>
      <translation>ESCRIBA LA NOTA; RETURN LA GUARDA, ESC LA DEJA COMO ESTABA; LAS TECLAS F SIGUEN FUNCIONANDO</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets.py" />
      <source>TYPE WHAT IS TO BE ADDED FIRST, THEN PRESS F2</source>
      <translation>ESCRIBA PRIMERO LO QUE SE SUMA, Y OPRIMA F2</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets.py" />
      <source>T{number} IS NOT SET: X AND Z BELONG TOGETHER</source>
      <translation>T{number} NO SE PUSO: X Y Z VAN JUNTAS</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets.py" />
      <source>X AND Z ARE SHOWN FROM THE MASTER: PRESS F3, THEN TYPE THEM FROM HOME</source>
      <translation>X Y Z SE MUESTRAN DESDE LA MAESTRA: OPRIMA F3, Y ESCRÍBALAS DESDE LA REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets_view.py" />
      <source>ADD</source>
      <translation>SUMAR</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets_view.py" />
      <source>TOOL OFFSETS</source>
      <translation>HERRAMIENTAS</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_offsets_view.py" />
      <source>X AND Z FROM THE MASTER T{number}</source>
      <translation>X Y Z DESDE LA MAESTRA T{number}</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>LEFT AND RIGHT TURN THROUGH WHAT THERE IS</source>
      <translation>IZQUIERDA Y DERECHA RECORREN LO QUE HAY</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>LEFT AND RIGHT, OR A FINGER, TURN THROUGH WHAT THERE IS; RETURN SETS IT</source>
      <translation>IZQUIERDA Y DERECHA, O UN DEDO, RECORREN LO QUE HAY; RETURN LO FIJA</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>PRESS RETURN TO WRITE IT</source>
      <translation>OPRIMA RETURN PARA ESCRIBIRLO</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>PRESS Y TO FORGET THE SHAPE OF T{number}, ESC TO KEEP IT</source>
      <translation>OPRIMA Y PARA OLVIDAR LA FORMA DE T{number}, ESC PARA CONSERVARLA</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>Page up and Page down: another tool; F3: no shape; F8: the table of tools; Esc leaves</source>
      <translation>Re Pág y Av Pág: otra herramienta; F3: sin forma; F8: la tabla de herramientas; Esc sale</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>TYPE IT; RETURN KEEPS IT, ESC LEAVES IT AS IT WAS; F-KEYS STILL WORK</source>
      <translation>ESCRÍBALO; RETURN LO GUARDA, ESC LO DEJA COMO ESTABA; LAS TECLAS F SIGUEN ACTIVAS</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>T{number} HAS NO SHAPE</source>
      <translation>T{number} NO TIENE FORMA</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>UP AND DOWN CHOOSE A FIELD; TYPE A VALUE OR A SUM, RETURN SETS IT; 0: NOT STATED</source>
      <translation>ARRIBA Y ABAJO ELIGEN UN CAMPO; ESCRIBA UN VALOR O UNA SUMA, RETURN LO FIJA; 0: SIN INDICAR</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes.py" />
      <source>no shape</source>
      <translation>sin forma</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes_view.py" />
      <source>ASSUMED: {names}</source>
      <translation>SUPUESTO: {names}</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes_view.py" />
      <source>NO SHAPE: THE PROOF TAKES THE NOSE ALONE</source>
      <translation>SIN FORMA: LA PRUEBA SOLO TOMA LA PUNTA</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes_view.py" />
      <source>NONE</source>
      <translation>NINGUNO</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes_view.py" />
      <source>SHAPE OF T{number}</source>
      <translation>FORMA DE T{number}</translation>
    </message>
    <message>
      <location filename="app/offsets/tool_shapes_view.py" />
      <source>THIS SHAPE CANNOT BE</source>
      <translation>ESTA FORMA NO PUEDE SER</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>A PROGRAM IS UNDER WAY: G54 TO G59 CHANGE BETWEEN CYCLES ONLY</source>
      <translation>HAY UN PROGRAMA EN CURSO: G54 A G59 SÓLO CAMBIAN ENTRE CICLOS</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>C, DEGREES?</source>
      <translation>¿C, GRADOS?</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>C: all cleared</source>
      <translation>C: todo borrado</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>F2: where the machine stands reads what is typed        C: clear G54 to G59        Esc: exit</source>
      <translation>F2: donde está la máquina lee lo que se escribe        C: borra G54 a G59        Esc: sale</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>G{code} IS AS IT WAS</source>
      <translation>G{code} QUEDA COMO ESTABA</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>PRESS Y TO CLEAR G54 TO G59, ESC TO KEEP THEM</source>
      <translation>OPRIMA Y PARA BORRAR G54 A G59, ESC PARA CONSERVARLOS</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>THIS MACHINE HAS NO AXIS {axis}</source>
      <translation>ESTA MÁQUINA NO TIENE EJE {axis}</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>TYPE A VALUE OR A SUM AND PRESS RETURN; ARROWS AND TAB CHOOSE ANOTHER CELL</source>
      <translation>ESCRIBA UN VALOR O UNA SUMA Y OPRIMA RETURN; FLECHAS Y TAB ELIGEN OTRA CELDA</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>X RADIUS, MM?</source>
      <translation>¿RADIO X, MM?</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>Z, MM?</source>
      <translation>¿Z, MM?</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>degrees</source>
      <translation>grados</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>reads {value}</source>
      <translation>lee {value}</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets.py" />
      <source>{axis} DOES NOT KNOW ITS POSITION: HOME IT FIRST</source>
      <translation>{axis} NO CONOCE SU POSICIÓN: REFERÉNCIELO PRIMERO</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets_view.py" />
      <source>HERE</source>
      <translation>AQUÍ</translation>
    </message>
    <message>
      <location filename="app/offsets/zero_offsets_view.py" />
      <source>SETTABLE OFFSETS  ·  X IS A RADIUS  ·  MM AND DEGREES</source>
      <translation>CEROS AJUSTABLES  ·  X ES RADIO  ·  MM Y GRADOS</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>FINDINGS</source>
      <translation>AVISOS</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>FORGET</source>
      <translation>OLVIDAR</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>KEPT WITH {name}</source>
      <translation>GUARDADO CON {name}</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>LEFT AND RIGHT TURN THE KIND OF STOCK; F6: NOTHING IS SAID ANY MORE</source>
      <translation>IZQUIERDA Y DERECHA CAMBIAN EL TIPO DE MATERIAL; F6: YA NO SE INDICA NADA</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>LOAD A PROGRAM FIRST: ITS STOCK IS KEPT WITH IT</source>
      <translation>CARGUE ANTES UN PROGRAMA: SU MATERIAL SE GUARDA CON ÉL</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>MARK THE FINDING WHOSE CHECK IS TO BE SILENCED</source>
      <translation>MARQUE EL AVISO CUYA COMPROBACIÓN SE SILENCIA</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>NO PART IS PROVED ON A MILL</source>
      <translation>EN UNA FRESADORA NO SE PRUEBA PIEZA</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>NOT KEPT: {why}</source>
      <translation>SIN GUARDAR: {why}</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>NOTHING IS SAID OF THE STOCK ANY MORE</source>
      <translation>YA NO HAY NADA INDICADO DEL MATERIAL</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>NOTHING IS SAID OF THIS PROGRAM'S STOCK</source>
      <translation>NO HAY NADA INDICADO DEL MATERIAL DE ESTE PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>ONLY CHECKS OF THE PART ARE SILENCED; THIS IS ONE OF THE PROGRAM</source>
      <translation>SOLO SE SILENCIAN COMPROBACIONES DE LA PIEZA; ESTA ES DEL PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>SILENCE</source>
      <translation>SILENC.</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>STOCK</source>
      <translation>MATERIAL</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>THE MACHINE FILE SILENCES {check}: [checks]</source>
      <translation>EL ARCHIVO DE MÁQUINA SILENCIA {check}: [checks]</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>THE PROGRAM IS BEING PROVED: WAIT A MOMENT</source>
      <translation>SE ESTÁ PROBANDO EL PROGRAMA: ESPERE UN MOMENTO</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>TYPE A LENGTH OR A SUM, RETURN KEEPS IT WITH THE PROGRAM; 0: NOT SAID</source>
      <translation>ESCRIBA UNA LONGITUD O SUMA, RETORNO LA GUARDA CON EL PROGRAMA; 0: NO INDICADO</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>TYPE THE NAME OF THE FILE; RETURN TAKES IT, ESC LEAVES IT AS IT WAS</source>
      <translation>ESCRIBA EL NOMBRE DEL ARCHIVO; RETORNO LO TOMA, ESC LO DEJA COMO ESTABA</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>TYPE THE REASON, RETURN KEEPS IT WITH THE PROGRAM; ESC LEAVES THE CHECK ON</source>
      <translation>ESCRIBA EL MOTIVO, RETORNO LO GUARDA CON EL PROGRAMA; ESC DEJA LA COMPROBACIÓN</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>UP AND DOWN SHOW THE PLACE OF A FINDING; F2: STOCK, F4 SILENCES A CHECK</source>
      <translation>ARRIBA Y ABAJO MUESTRAN EL LUGAR DE UN AVISO; F2: MATERIAL, F4 SILENCIA</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>WHAT THE PART IS PROVED ON CHANGES BETWEEN TWO CYCLES ONLY</source>
      <translation>LO QUE SUPONE LA PRUEBA DE LA PIEZA SOLO CAMBIA ENTRE DOS CICLOS</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>a check is not silenced without a reason</source>
      <translation>una comprobación no se silencia sin motivo</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>there is no file {name} beside the program</source>
      <translation>no hay archivo {name} junto al programa</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>{check} IS LOOKED FOR AGAIN</source>
      <translation>{check} SE BUSCA DE NUEVO</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet.py" />
      <source>{check} IS SILENCED</source>
      <translation>{check} QUEDA SILENCIADA</translation>
    </message>
    <message>
      <location filename="app/part/part_sheet_view.py" />
      <source>PART</source>
      <translation>PIEZA</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>ALLOWANCE</source>
      <translation>DEMASÍA</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>ASSUMED</source>
      <translation>SUPUESTO</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>BAR</source>
      <translation>BARRA</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>CHECK</source>
      <translation>COMPROBACIÓN</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>COUNTS ONLY WITH [clamping] IN THE MACHINE FILE</source>
      <translation>SOLO CUENTA CON [clamping] EN EL ARCHIVO DE MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>ELEMENTARY BLOCK {n}</source>
      <translation>BLOQUE ELEMENTAL {n}</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>F4 UNDOES IT</source>
      <translation>F4 LO DESHACE</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>FINDINGS  ·  {name}</source>
      <translation>AVISOS  ·  {name}</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>LENGTH</source>
      <translation>LONGITUD</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>NO PROGRAM</source>
      <translation>SIN PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>NOT PROVED YET</source>
      <translation>AÚN NO PROBADO</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>NOTHING WAS FOUND</source>
      <translation>NO SE ENCONTRÓ NADA</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>NOTHING WAS FOUND; THIS PROGRAM HAS NO PART</source>
      <translation>NO SE ENCONTRÓ NADA; ESTE PROGRAMA NO TIENE PIEZA</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>SAID</source>
      <translation>INDICADO</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>SILENCED BY THE MACHINE FILE</source>
      <translation>SILENCIADO POR EL ARCHIVO DE MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>STOCK  ·  {name}</source>
      <translation>MATERIAL  ·  {name}</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>TUBE</source>
      <translation>TUBO</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>WHAT</source>
      <translation>QUÉ</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>WHY IS {check} SILENCED?</source>
      <translation>¿POR QUÉ SILENCIAR {check}?</translation>
    </message>
    <message>
      <location filename="app/part/part_tables.py" />
      <source>{field} IS STILL TO BE SAID</source>
      <translation>FALTA INDICAR {field}</translation>
    </message>
    <message>
      <location filename="app/part/stock_entry.py" />
      <source>OF A PROGRAM</source>
      <translation>DE UN PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/part/stock_entry.py" />
      <source>a length of the stock is not negative; 0 takes it back</source>
      <translation>una longitud del material no es negativa; 0 la retira</translation>
    </message>
    <message>
      <location filename="app/part/stock_entry.py" />
      <source>the bore of a tube is less than its diameter</source>
      <translation>el agujero de un tubo es menor que su diámetro</translation>
    </message>
    <message>
      <location filename="app/part/stock_entry.py" />
      <source>the stick-out is more than 0 and up to 40 in</source>
      <translation>el voladizo es mayor que 0 y hasta 40 in</translation>
    </message>
    <message>
      <location filename="app/path/measuring.py" />
      <source>ANGLE {axis}</source>
      <translation>ÁNGULO {axis}</translation>
    </message>
    <message>
      <location filename="app/path/measuring.py" />
      <source>ARROWS: NEXT POINT   TAB: ALONG THE PATH   RETURN: HOLD, AND MEASURE FROM THERE   ESC: BACK</source>
      <translation>FLECHAS: PUNTO SIGUIENTE   TAB: POR LA TRAYECTORIA   RETURN: FIJA, Y MIDE DESDE AHÍ   ESC: REGRESA</translation>
    </message>
    <message>
      <location filename="app/path/measuring.py" />
      <source>CENTRE</source>
      <translation>CENTRO</translation>
    </message>
    <message>
      <location filename="app/path/measuring.py" />
      <source>CROSSING</source>
      <translation>CRUCE</translation>
    </message>
    <message>
      <location filename="app/path/measuring.py" />
      <source>ROUND</source>
      <translation>REDONDO</translation>
    </message>
    <message>
      <location filename="app/path/measuring.py" />
      <source>TO X</source>
      <translation>A LA X</translation>
    </message>
    <message>
      <location filename="app/path/measuring.py" />
      <source>TO Z</source>
      <translation>A LA Z</translation>
    </message>
    <message>
      <location filename="app/path/part_bar_view.py" />
      <source>LINE {line}</source>
      <translation>LÍNEA {line}</translation>
    </message>
    <message>
      <location filename="app/path/path_aspects.py" />
      <source>FACE</source>
      <translation>CARA</translation>
    </message>
    <message>
      <location filename="app/path/path_aspects.py" />
      <source>OPEN</source>
      <translation>ABRIR</translation>
    </message>
    <message>
      <location filename="app/path/path_aspects.py" />
      <source>PATH</source>
      <translation>TRAYECTORIA</translation>
    </message>
    <message>
      <location filename="app/path/path_aspects.py" />
      <source>SECTION</source>
      <translation>SECCIÓN</translation>
    </message>
    <message>
      <location filename="app/path/path_aspects.py" />
      <source>SIDE</source>
      <translation>LADO</translation>
    </message>
    <message>
      <location filename="app/path/path_aspects.py" />
      <source>SOLID</source>
      <translation>SÓLIDO</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>AT MOST {length} {unit} APART  ·  AT THE CIRCLE</source>
      <translation>A LO MÁS {length} {unit} DE DIFERENCIA  ·  EN EL CÍRCULO</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>FACE  ·  SEEN FROM THE TAILSTOCK</source>
      <translation>CARA  ·  VISTA DESDE EL CONTRAPUNTO</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>NOTHING THAT IS CUT HAS CHANGED</source>
      <translation>NO CAMBIÓ NADA DE LO QUE SE CORTA</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>PART  ·  BEING MADE</source>
      <translation>PIEZA  ·  HACIÉNDOSE</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>PART  ·  NOTHING IS CUT</source>
      <translation>PIEZA  ·  NO SE CORTA NADA</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>PART  ·  THE STOCK</source>
      <translation>PIEZA  ·  EL MATERIAL</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>PART  ·  T{tool}</source>
      <translation>PIEZA  ·  T{tool}</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>SIDE  ·  UNROLLED AT Ø {diameter}</source>
      <translation>LADO  ·  DESARROLLADO EN Ø {diameter}</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>after</source>
      <translation>después</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>before</source>
      <translation>antes</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>done</source>
      <translation>hecho</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>rapid</source>
      <translation>rápido</translation>
    </message>
    <message>
      <location filename="app/path/path_marks_view.py" />
      <source>to come</source>
      <translation>por hacer</translation>
    </message>
    <message>
      <location filename="app/path/path_view.py" />
      <source>MEAS</source>
      <translation>MEDIR</translation>
    </message>
    <message>
      <location filename="app/path/path_view.py" />
      <source>Play fast</source>
      <translation>Reproducir rápido</translation>
    </message>
    <message>
      <location filename="app/path/path_view.py" />
      <source>Step back</source>
      <translation>Paso atrás</translation>
    </message>
    <message>
      <location filename="app/path/path_view.py" />
      <source>Step on</source>
      <translation>Paso adelante</translation>
    </message>
    <message>
      <location filename="app/path/path_view.py" />
      <source>The path is shown when a program is loaded.</source>
      <translation>La trayectoria se muestra cuando hay un programa cargado.</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>%1 CANNOT BE DELETED: %2</source>
      <translation>NO SE PUEDE BORRAR %1: %2</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>%1 CANNOT BE RENAMED: %2</source>
      <translation>NO SE PUEDE CAMBIAR EL NOMBRE DE %1: %2</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>%1 IS ITS NAME ALREADY</source>
      <translation>%1 YA ES SU NOMBRE</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>%1 IS NOT THERE ANY MORE</source>
      <translation>%1 YA NO ESTÁ</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>%1 IS THERE ALREADY; TAKE ANOTHER NAME</source>
      <translation>%1 YA EXISTE; USE OTRO NOMBRE</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>%1 WOULD BE HIDDEN; TAKE A NAME WITHOUT A POINT IN FRONT</source>
      <translation>%1 QUEDARÍA OCULTO; USE UN NOMBRE SIN PUNTO AL PRINCIPIO</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>A SAMPLE IS LEFT AS IT IS: COPY IT FIRST (F4)</source>
      <translation>LAS MUESTRAS NO SE TOCAN: CÓPIELA PRIMERO (F4)</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>ITS NAME IS {name} NOW</source>
      <translation>AHORA SE LLAMA {name}</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>NAME OF THE COPY?</source>
      <translation>¿NOMBRE DE LA COPIA?</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>NEW NAME?</source>
      <translation>¿NOMBRE NUEVO?</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>NO PROGRAM IS MARKED</source>
      <translation>NO HAY PROGRAMA MARCADO</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>NOT DELETED, BECAUSE ITS TEXT CANNOT BE KEPT: %1</source>
      <translation>NO SE BORRÓ, PORQUE SU TEXTO NO SE PUEDE GUARDAR: %1</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>NOTHING IS ENTERED; TYPE A NAME</source>
      <translation>NO SE ESCRIBIÓ NADA; ESCRIBA UN NOMBRE</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>PRESS Y TO DELETE {name} (ITS VERSIONS ARE KEPT), ESC TO LEAVE IT</source>
      <translation>OPRIMA Y PARA BORRAR {name} (SUS VERSIONES SE GUARDAN), ESC PARA DEJARLO</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>RENAMED, BUT ITS VERSIONS STAY UNDER %1: %2</source>
      <translation>CAMBIÓ DE NOMBRE, PERO SUS VERSIONES QUEDAN EN %1: %2</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>STILL AT IT: WAIT UNTIL IT IS DONE</source>
      <translation>TODAVÍA TRABAJANDO: ESPERE A QUE TERMINE</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>{name} IS DELETED; ITS VERSIONS ARE KEPT</source>
      <translation>{name} QUEDÓ BORRADO; SUS VERSIONES SE GUARDAN</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>{name} IS INTERRUPTED: FINISH IT, OR GIVE IT UP, FIRST</source>
      <translation>{name} ESTÁ INTERRUMPIDO: PRIMERO TERMÍNELO O ABANDÓNELO</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>{name} IS THERE NOW</source>
      <translation>YA ESTÁ {name}</translation>
    </message>
    <message>
      <location filename="app/programs/copy_rename_delete.py" />
      <source>{name} IS UNDER WAY: LET IT END FIRST</source>
      <translation>{name} ESTÁ EN CURSO: DEJE QUE TERMINE</translation>
    </message>
    <message>
      <location filename="app/programs/file_prompt_view.py" />
      <source>%1 programs</source>
      <translation>%1 programas</translation>
    </message>
    <message>
      <location filename="app/programs/file_prompt_view.py" />
      <source>RETURN takes the marked program   ESC keeps the present one   F2 shows the list</source>
      <translation>RETURN toma el programa marcado   ESC conserva el actual   F2 muestra la lista</translation>
    </message>
    <message>
      <location filename="app/programs/folder_chooser.py" />
      <source>%1 CANNOT BE READ: %2</source>
      <translation>NO SE PUEDE LEER %1: %2</translation>
    </message>
    <message>
      <location filename="app/programs/folder_chooser.py" />
      <source>FOLDER</source>
      <translation>CARPETA</translation>
    </message>
    <message>
      <location filename="app/programs/folder_chooser.py" />
      <source>NAME</source>
      <translation>NOMBRE</translation>
    </message>
    <message>
      <location filename="app/programs/folder_chooser.py" />
      <source>PLACES</source>
      <translation>LUGARES</translation>
    </message>
    <message>
      <location filename="app/programs/folder_chooser.py" />
      <source>PROGRAM</source>
      <translation>PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/programs/folder_chooser.py" />
      <source>THIS CONTROL</source>
      <translation>ESTE CONTROL</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>%1 IS LARGER THAN ANY PROGRAM (%2 MB)</source>
      <translation>%1 ES MÁS GRANDE QUE CUALQUIER PROGRAMA (%2 MB)</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>%1 IS NO PROGRAM: %2</source>
      <translation>%1 NO ES UN PROGRAMA: %2</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>%1 IS NOT REPLACED, BECAUSE ITS TEXT CANNOT BE KEPT: %2</source>
      <translation>%1 NO SE REEMPLAZA, PORQUE SU TEXTO NO SE PUEDE GUARDAR: %2</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>ALL HERE</source>
      <translation>TODO ACÁ</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>COPYING: LEAVE THE STICK WHERE IT IS</source>
      <translation>COPIANDO: NO SAQUE LA MEMORIA</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>EXPORT %1</source>
      <translation>EXPORTAR %1</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>F4 EXPORTS TO THE FOLDER THAT IS OPEN; RETURN OPENS FOLDERS</source>
      <translation>F4 EXPORTA A LA CARPETA ABIERTA; RETURN ABRE CARPETAS</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>IMPORT</source>
      <translation>IMPORTAR</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>LOOK</source>
      <translation>BUSCAR</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>NO PROGRAM IS IN THIS FOLDER</source>
      <translation>NO HAY PROGRAMAS EN ESTA CARPETA</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>ONE HERE</source>
      <translation>UNO ACÁ</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>OPEN A PLACE FIRST: ARROWS MARK IT, RETURN OPENS IT</source>
      <translation>ABRA PRIMERO UN LUGAR: LAS FLECHAS LO MARCAN, RETURN LO ABRE</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>RETURN OPENS A PLACE OR FOLDER, ON A PROGRAM IT IMPORTS IT; F5 IMPORTS ALL; ESC GOES BACK</source>
      <translation>RETURN ABRE UN LUGAR O CARPETA, Y SOBRE UN PROGRAMA LO IMPORTA; F5 IMPORTA TODO; ESC REGRESA</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>RETURN OPENS A PLACE OR FOLDER; F4 COPIES THE MARKED PROGRAM THERE, F5 ALL; ESC GOES BACK</source>
      <translation>RETURN ABRE UN LUGAR O CARPETA; F4 COPIA AHÍ EL PROGRAMA MARCADO, F5 TODOS; ESC REGRESA</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>replaced by an import</source>
      <translation>reemplazado por una importación</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>{count} COPIED, READ BACK AND ON THE DISK: A STICK IS SAFE TO REMOVE</source>
      <translation>{count} COPIADOS, RELEÍDOS Y EN EL DISCO: YA PUEDE SACAR LA MEMORIA</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>{count} IMPORTED AND PROVED WITHOUT AN ERROR</source>
      <translation>{count} IMPORTADOS Y COMPROBADOS SIN ERROR</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>{count} IMPORTED; NOT ALL PROVE: {found}</source>
      <translation>{count} IMPORTADOS; NO TODOS PASAN LA COMPROBACIÓN: {found}</translation>
    </message>
    <message>
      <location filename="app/programs/import_export.py" />
      <source>{names}: THERE ALREADY WITH ANOTHER TEXT. PRESS Y TO REPLACE, ESC TO KEEP</source>
      <translation>{names}: YA EXISTE CON OTRO TEXTO. OPRIMA Y PARA REEMPLAZAR, ESC PARA CONSERVAR</translation>
    </message>
    <message>
      <location filename="app/programs/preview.py" />
      <source>TOO LARGE FOR A PREVIEW</source>
      <translation>DEMASIADO GRANDE PARA LA VISTA PREVIA</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>%1 OF %2 PROGRAMS</source>
      <translation>%1 DE %2 PROGRAMAS</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>%1 PROGRAMS</source>
      <translation>%1 PROGRAMAS</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>BEST</source>
      <translation>MEJOR</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>BEST CYCLE</source>
      <translation>MEJOR CICLO</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>COPY</source>
      <translation>COPIAR</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>DELETE</source>
      <translation>BORRAR</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>EXPORT</source>
      <translation>EXPORTAR</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>LAST CYCLE</source>
      <translation>ÚLTIMO CICLO</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>LAST PROOF</source>
      <translation>ÚLTIMA PRUEBA</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>LAST RUN</source>
      <translation>ÚLTIMA CORRIDA</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>NEVER PROVED</source>
      <translation>NUNCA COMPROBADO</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>OWN PROGRAM</source>
      <translation>PROGRAMA PROPIO</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>PLANNED</source>
      <translation>PREVISTO</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>PROGRAMS  ·  %1  ·  BY %2</source>
      <translation>PROGRAMAS  ·  %1  ·  POR %2</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>PROVED</source>
      <translation>COMPROBADO</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>RENAME</source>
      <translation>NOMBRAR</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>RETURN LOADS THE MARKED PROGRAM ONCE NONE IS UNDER WAY; H HOLDS</source>
      <translation>RETURN CARGA EL PROGRAMA MARCADO CUANDO NO HAYA OTRO EN CURSO; H RETIENE</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>SORT</source>
      <translation>ORDENAR</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>TYPE A NAME AND PRESS RETURN; ESC KEEPS EVERYTHING AS IT IS</source>
      <translation>ESCRIBA UN NOMBRE Y OPRIMA RETURN; ESC DEJA TODO COMO ESTÁ</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>TYPE A PART OF A NAME, OR MARK IT WITH ARROWS; RETURN LOADS IT; ESC FOR AUTOMATIC</source>
      <translation>ESCRIBA PARTE DEL NOMBRE, O MÁRQUELO CON FLECHAS; RETURN LO CARGA; ESC A AUTOMÁTICO</translation>
    </message>
    <message>
      <location filename="app/programs/program_list.py" />
      <source>WHERE</source>
      <translation>DÓNDE</translation>
    </message>
    <message>
      <location filename="app/programs/program_rows.py" />
      <source>DATE</source>
      <translation>FECHA</translation>
    </message>
    <message>
      <location filename="app/programs/programs_view.py" />
      <source>DRAWING …</source>
      <translation>DIBUJANDO …</translation>
    </message>
    <message>
      <location filename="app/programs/programs_view.py" />
      <source>PREVIEW</source>
      <translation>VISTA PREVIA</translation>
    </message>
    <message>
      <location filename="app/programs/programs_view.py" />
      <source>RECORD</source>
      <translation>REGISTRO</translation>
    </message>
    <message>
      <location filename="app/programs/run_history.py" />
      <source>%1 ERRORS: %2</source>
      <translation>%1 ERRORES: %2</translation>
    </message>
    <message>
      <location filename="app/programs/run_history.py" />
      <source>: the control ended in the middle of its last run</source>
      <translation>: el control terminó en medio de su última corrida</translation>
    </message>
    <message>
      <location filename="app/programs/run_history.py" />
      <source>ALARM %1</source>
      <translation>ALARMA %1</translation>
    </message>
    <message>
      <location filename="app/programs/run_history.py" />
      <source>COMPLETE</source>
      <translation>COMPLETO</translation>
    </message>
    <message>
      <location filename="app/programs/run_history.py" />
      <source>CUT OFF</source>
      <translation>CORTADO</translation>
    </message>
    <message>
      <location filename="app/programs/run_history.py" />
      <source>E-STOP</source>
      <translation>PARO DE EMERGENCIA</translation>
    </message>
    <message>
      <location filename="app/programs/run_history.py" />
      <source>GIVEN UP</source>
      <translation>ABANDONADO</translation>
    </message>
    <message>
      <location filename="app/programs/run_history.py" />
      <source>NOT COUNTED</source>
      <translation>NO CONTADO</translation>
    </message>
    <message>
      <location filename="app/programs/whole_file.py" />
      <source>%1 CANNOT BE BROUGHT TO THE DISK: %2</source>
      <translation>%1 NO SE PUEDE LLEVAR AL DISCO: %2</translation>
    </message>
    <message>
      <location filename="app/programs/whole_file.py" />
      <source>%1 CANNOT BE WRITTEN: %2</source>
      <translation>NO SE PUEDE ESCRIBIR %1: %2</translation>
    </message>
    <message>
      <location filename="app/programs/whole_file.py" />
      <source>%1 DOES NOT READ BACK AS IT WAS WRITTEN: TAKE ANOTHER STICK</source>
      <translation>%1 NO SE LEE COMO SE ESCRIBIÓ: USE OTRA MEMORIA</translation>
    </message>
    <message>
      <location filename="app/programs/whole_file.py" />
      <source>NOT SAVED: %1</source>
      <translation>NO SE GUARDÓ: %1</translation>
    </message>
    <message>
      <location filename="app/programs/whole_file.py" />
      <source>NOT SAVED: THE TEXT HOLDS SIGNS THAT NO PROGRAM FILE CAN KEEP</source>
      <translation>NO SE GUARDÓ: EL TEXTO TIENE SIGNOS QUE NINGÚN ARCHIVO DE PROGRAMA PUEDE GUARDAR</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>AVERAGE</source>
      <translation>PROMEDIO</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>CONTROL CHARTS</source>
      <translation>GRÁFICAS DE CONTROL</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>CONTROL CHARTS  ·  %1</source>
      <translation>GRÁFICAS DE CONTROL  ·  %1</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>DRIFT</source>
      <translation>DERIVA</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>MEAN %1</source>
      <translation>MEDIA %1</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>MOVING RANGE</source>
      <translation>RANGO MÓVIL</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>NOTHING IS MEASURED OF THIS FEATURE YET</source>
      <translation>DE ESTA CARACTERÍSTICA AÚN NO SE HA MEDIDO NADA</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>RANGE</source>
      <translation>RANGO</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>READ</source>
      <translation>LEÍDAS</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>SINGLE PARTS</source>
      <translation>PIEZAS SUELTAS</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>THE ARROWS CHOOSE A FEATURE; BROKEN LINES: CONTROL LIMITS, DOTTED: TOLERANCE, RINGS: RULES</source>
      <translation>LAS FLECHAS ELIGEN; LÍNEAS CORTADAS: LÍMITES DE CONTROL, PUNTEADAS: TOLERANCIA, ANILLOS: REGLAS</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>limits, Cpk, drift</source>
      <translation>límites, Cpk, deriva</translation>
    </message>
    <message>
      <location filename="app/quality/charts_section.py" />
      <source>none; Cpk is {least} at least (95 %)</source>
      <translation>ninguna; Cpk es al menos {least} (95 %)</translation>
    </message>
    <message>
      <location filename="app/quality/correction_effect.py" />
      <source>NOW</source>
      <translation>AHORA</translation>
    </message>
    <message>
      <location filename="app/quality/correction_effect.py" />
      <source>THE PART CANNOT BE COMPARED: {why}</source>
      <translation>LA PIEZA NO SE PUEDE COMPARAR: {why}</translation>
    </message>
    <message>
      <location filename="app/quality/correction_effect.py" />
      <source>THEN</source>
      <translation>DESPUÉS</translation>
    </message>
    <message>
      <location filename="app/quality/correction_effect.py" />
      <source>{name}: {change} FROM THE NEXT PART ON</source>
      <translation>{name}: {change} DESDE LA PIEZA SIGUIENTE</translation>
    </message>
    <message>
      <location filename="app/quality/cycle_recorder.py" />
      <source>BETWEEN CYCLES</source>
      <translation>ENTRE CICLOS</translation>
    </message>
    <message>
      <location filename="app/quality/cycle_recorder.py" />
      <source>RESTARTED</source>
      <translation>REANUDADO</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>%1 is no whole number</source>
      <translation>%1 no es un número entero</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>A LARGER OFFSET MAKES IT</source>
      <translation>UNA COMPENSACIÓN MAYOR LA HACE</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>BY</source>
      <translation>POR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>CHANGE</source>
      <translation>CAMBIAR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>CORRECTED BY</source>
      <translation>SE CORRIGE CON</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>ENTER THE FEATURE FIELD BY FIELD; F6 KEEPS IT, ESC LEAVES IT</source>
      <translation>INTRODUZCA LA CARACTERÍSTICA CAMPO POR CAMPO; F6 LA GUARDA, ESC LA DEJA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>F2 enters a feature, Return changes the marked one. F5: whether parts wait for the plan.</source>
      <translation>F2 introduce una característica, Return cambia la marcada. F5: si las piezas esperan al plan.</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>FEATURES</source>
      <translation>CARACTERÍSTICAS</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>FEATURES  ·  %1</source>
      <translation>CARACTERÍSTICAS  ·  %1</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>GO ON</source>
      <translation>SEGUIR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>ITS NUMBER</source>
      <translation>SU NÚMERO</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>KEEP</source>
      <translation>GUARDAR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>LARGER</source>
      <translation>MAYOR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>LOWER DEVIATION</source>
      <translation>DESVIACIÓN INFERIOR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>MEASURE EVERY (0: NO PLAN)</source>
      <translation>MEDIR CADA (0: SIN PLAN)</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>MEASURED</source>
      <translation>MEDIDO</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>NEW</source>
      <translation>NUEVA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>NOMINAL</source>
      <translation>NOMINAL</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>NOMINAL %1</source>
      <translation>NOMINAL %1</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>PARTS GO ON</source>
      <translation>LAS PIEZAS SIGUEN</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>PARTS IN A SAMPLE</source>
      <translation>PIEZAS POR MUESTRA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>PARTS WAIT UNTIL THE PLAN IS DONE</source>
      <translation>LAS PIEZAS ESPERAN HASTA CUMPLIR EL PLAN</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>PRESS Y TO MEASURE {name} NO MORE (ITS READINGS STAY IN THE STORE), ESC TO KEEP IT</source>
      <translation>PULSE Y PARA NO MEDIR MÁS {name} (SUS LECTURAS SE CONSERVAN), ESC PARA DEJARLA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>REMOVE</source>
      <translation>QUITAR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>RETURN CHANGES THE MARKED FEATURE, F2 ENTERS ANOTHER; ESC GOES BACK TO THE LIST</source>
      <translation>RETURN CAMBIA LA MARCADA, F2 INTRODUCE OTRA; ESC VUELVE A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>RETURN TURNS IT OVER</source>
      <translation>RETURN LO CAMBIA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>Return takes what is typed and goes on; F6 keeps the feature, Esc leaves it as it was.</source>
      <translation>Return toma lo escrito y sigue; F6 guarda la característica, Esc la deja como estaba.</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>SECONDARY OFFSET</source>
      <translation>COMPENSACIÓN SECUNDARIA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>SMALLER</source>
      <translation>MENOR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>TOLERANCE</source>
      <translation>TOLERANCIA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>UPPER DEVIATION</source>
      <translation>DESVIACIÓN SUPERIOR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>WAIT</source>
      <translation>ESPERAR</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>WEAR OF A TOOL</source>
      <translation>DESGASTE DE HERRAMIENTA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>every {count}</source>
      <translation>cada {count}</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>nominal, tolerance, tool, sample plan</source>
      <translation>nominal, tolerancia, herramienta, plan</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>{name} KEPT</source>
      <translation>{name} GUARDADA</translation>
    </message>
    <message>
      <location filename="app/quality/features_section.py" />
      <source>{name} REMOVED</source>
      <translation>{name} QUITADA</translation>
    </message>
    <message>
      <location filename="app/quality/gauge_line.py" />
      <source>No gauge: [gauge] of the machine file names its serial port.</source>
      <translation>Sin calibrador: [gauge] del archivo de máquina nombra su puerto serie.</translation>
    </message>
    <message>
      <location filename="app/quality/gauge_line.py" />
      <source>THE MACHINE FILE NAMES NO GAUGE: [gauge] port = …</source>
      <translation>EL ARCHIVO DE MÁQUINA NO NOMBRA CALIBRADOR: [gauge] port = …</translation>
    </message>
    <message>
      <location filename="app/quality/gauge_line.py" />
      <source>no gauge is plugged in, or it is off</source>
      <translation>no hay calibrador conectado, o está apagado</translation>
    </message>
    <message>
      <location filename="app/quality/gauge_line.py" />
      <source>the gauge has sent something unreadable</source>
      <translation>el calibrador ha enviado algo ilegible</translation>
    </message>
    <message>
      <location filename="app/quality/parts_book.py" />
      <source>NO MEASURED PARTS ARE KEPT HERE</source>
      <translation>AQUÍ NO SE GUARDAN PIEZAS MEDIDAS</translation>
    </message>
    <message>
      <location filename="app/quality/parts_function.py" />
      <source>DUE</source>
      <translation>PENDIENTE</translation>
    </message>
    <message>
      <location filename="app/quality/parts_function.py" />
      <source>KEPT</source>
      <translation>SE CONSERVA</translation>
    </message>
    <message>
      <location filename="app/quality/parts_function.py" />
      <source>MEASURED PARTS</source>
      <translation>PIEZAS MEDIDAS</translation>
    </message>
    <message>
      <location filename="app/quality/parts_function.py" />
      <source>PRESS RETURN FOR THE MEASURED PARTS; ESC GOES BACK TO THE LIST</source>
      <translation>PULSE RETURN PARA LAS PIEZAS MEDIDAS; ESC VUELVE A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/quality/parts_function.py" />
      <source>READINGS</source>
      <translation>LECTURAS</translation>
    </message>
    <message>
      <location filename="app/quality/parts_function.py" />
      <source>Return opens the page; W of the main menu does so too.</source>
      <translation>Return abre la página; W del menú principal también.</translation>
    </message>
    <message>
      <location filename="app/quality/parts_function.py" />
      <source>readings, charts, tool life, trends</source>
      <translation>lecturas, gráficas, vida útil, tendencias</translation>
    </message>
    <message>
      <location filename="app/quality/plots_view.py" />
      <source>NOTHING TO DRAW YET</source>
      <translation>AÚN NO HAY NADA QUE DIBUJAR</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>%1 is more than 0; type the measured size, not the deviation</source>
      <translation>%1 es mayor que 0; escriba la medida, no la desviación</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>A READING CAME WHILE THE READINGS WERE NOT SHOWN: MEASURE AGAIN</source>
      <translation>LLEGÓ UNA LECTURA SIN ESTAR LAS LECTURAS A LA VISTA: MIDA DE NUEVO</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>ANOTHER CHANGE CAME AFTER IT; F8 AND F9 OF THE MAIN MENU HAVE THE HISTORY</source>
      <translation>DESPUÉS HUBO OTRO CAMBIO; F8 Y F9 DEL MENÚ PRINCIPAL TIENEN EL HISTORIAL</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>CORRECT</source>
      <translation>CORREGIR</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>DEVIATION</source>
      <translation>DESVIACIÓN</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>F8 proposes a correction, F9 takes the last one back.</source>
      <translation>F8 propone una corrección, F9 deshace la última.</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>GAUGE</source>
      <translation>CALIBR.</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>GOOD</source>
      <translation>BUENA</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>NO CORRECTION WAS TAKEN OVER HERE; F8 AND F9 OF THE MAIN MENU HAVE THE HISTORY</source>
      <translation>AQUÍ NO SE HA TOMADO NINGUNA CORRECCIÓN; F8 Y F9 DEL MENÚ PRINCIPAL TIENEN EL HISTORIAL</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>NO GAUGE</source>
      <translation>SIN CAL.</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>NONE YET</source>
      <translation>AÚN NADA</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>PART +</source>
      <translation>PIEZA +</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>PART −</source>
      <translation>PIEZA −</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>PRESS Y TO TAKE {size} OF PART {part} OUT, ESC TO KEEP IT</source>
      <translation>PULSE Y PARA QUITAR {size} DE LA PIEZA {part}, ESC PARA DEJARLA</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>READINGS  ·  %1</source>
      <translation>LECTURAS  ·  %1</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>STILL READING WHAT WAS KEPT: PRESS F8 AGAIN</source>
      <translation>AÚN LEYENDO LO GUARDADO: PULSE F8 OTRA VEZ</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>TAKE OUT</source>
      <translation>QUITAR</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>THE CORRECTION IS TAKEN BACK</source>
      <translation>LA CORRECCIÓN SE HA DESHECHO</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>THE READING IS TAKEN OUT</source>
      <translation>LA LECTURA SE HA QUITADO</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>TOO LARGE</source>
      <translation>GRANDE</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>TOO SMALL</source>
      <translation>PEQUEÑA</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>TYPE THE MEASURED SIZE AND PRESS RETURN; ESC GOES BACK TO THE LIST</source>
      <translation>ESCRIBA LA MEDIDA Y PULSE RETURN; ESC VUELVE A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>measure a part, take over a correction</source>
      <translation>medir una pieza, tomar una corrección</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>{name} OF PART {part}: {size} KEPT</source>
      <translation>{name} DE LA PIEZA {part}: {size} GUARDADA</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>{name} OF PART {part}?</source>
      <translation>¿{name} DE LA PIEZA {part}?</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>{name} {size} IS FAR OFF: PRESS Y TO KEEP IT ALL THE SAME, ESC TO MEASURE AGAIN</source>
      <translation>{name} {size} ESTÁ MUY LEJOS: PULSE Y PARA GUARDARLA AUN ASÍ, ESC PARA MEDIR DE NUEVO</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>{words}: PRESS Y TO TAKE IT OVER, ESC TO LEAVE IT</source>
      <translation>{words}: PULSE Y PARA TOMARLA, ESC PARA DEJARLA</translation>
    </message>
    <message>
      <location filename="app/quality/readings_section.py" />
      <source>{words}; IT COUNTS FROM THE NEXT PART</source>
      <translation>{words}; CUENTA DESDE LA PRÓXIMA PIEZA</translation>
    </message>
    <message>
      <location filename="app/quality/sample_plan.py" />
      <source>MEASURE PART {part}: {names}</source>
      <translation>MIDA LA PIEZA {part}: {names}</translation>
    </message>
    <message>
      <location filename="app/quality/sample_plan.py" />
      <source>part %1 is to be measured first: %2</source>
      <translation>antes hay que medir la pieza %1: %2</translation>
    </message>
    <message>
      <location filename="app/quality/section.py" />
      <source>CHOOSE A PROGRAM FIRST: EVERY PROGRAM HAS ITS OWN FEATURES</source>
      <translation>ELIJA PRIMERO UN PROGRAMA: CADA UNO TIENE SUS CARACTERÍSTICAS</translation>
    </message>
    <message>
      <location filename="app/quality/section.py" />
      <source>NO FEATURE IS ENTERED YET: SECTION 1, F2</source>
      <translation>AÚN NO HAY CARACTERÍSTICAS: SECCIÓN 1, F2</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>%1 is no number of parts; type a whole number</source>
      <translation>%1 no es un número de piezas; escriba un entero</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>LEFT</source>
      <translation>FALTA</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>MINUTES</source>
      <translation>MINUTOS</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>Minutes are those at feed. 0 takes a limit away. STOP: no other part begins when it is gone.</source>
      <translation>Los minutos son los de avance. 0 quita el límite. PARO: al agotarse no empieza otra pieza.</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>NO TOOL IS SET YET</source>
      <translation>AÚN NO HAY HERRAMIENTA PUESTA</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>PRESS Y WHEN T{number} HAS A FRESH INSERT ({words} ARE ON THE OLD ONE), ESC IF NOT</source>
      <translation>PULSE Y CUANDO T{number} TENGA INSERTO NUEVO (EL VIEJO LLEVA {words}), ESC SI NO</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>STOP</source>
      <translation>PARO</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>STOPS</source>
      <translation>PARADAS</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>TOOL LIFE</source>
      <translation>VIDA ÚTIL</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>TYPE THE LIMIT AND PRESS RETURN; F2 CHOOSES WHICH, F4 WHEN THE INSERT IS CHANGED</source>
      <translation>ESCRIBA EL LÍMITE Y PULSE RETURN; F2 ELIGE CUÁL, F4 AL CAMBIAR EL INSERTO</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>T{number} SAVED</source>
      <translation>T{number} GUARDADA</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>T{number} {limit}?</source>
      <translation>¿T{number} {limit}?</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>USED</source>
      <translation>USADO</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>WARN</source>
      <translation>AVISO</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>WARN AT %</source>
      <translation>AVISAR AL %</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>parts and minutes of an insert</source>
      <translation>piezas y minutos de un inserto</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_section.py" />
      <source>{count} parts</source>
      <translation>{count} piezas</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_watch.py" />
      <source>T{number}: A FRESH INSERT, ITS LIFE BEGINS AT NOUGHT</source>
      <translation>T{number}: INSERTO NUEVO, SU VIDA EMPIEZA DE CERO</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_watch.py" />
      <source>T{number}: ITS LIFE IS GONE, {words}</source>
      <translation>T{number}: SU VIDA SE ACABÓ, {words}</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_watch.py" />
      <source>T{number}: {words} OF ITS LIFE ARE GONE</source>
      <translation>T{number}: {words} DE SU VIDA ESTÁN GASTADOS</translation>
    </message>
    <message>
      <location filename="app/quality/tool_life_watch.py" />
      <source>the life of T%1 is gone, %2: change the insert and tell it in TOOL LIFE</source>
      <translation>la vida de T%1 se acabó, %2: cambie el inserto y dígalo en VIDA ÚTIL</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>AVAILABILITY</source>
      <translation>DISPONIBILIDAD</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>CYCLE TIME</source>
      <translation>TIEMPO DE CICLO</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>CYCLE TIME, s</source>
      <translation>TIEMPO DE CICLO, s</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>CYCLES RAN</source>
      <translation>EN CICLO</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>MINUTES BY REASON; TOGETHER WITH THOSE ABOVE</source>
      <translation>MINUTOS POR CAUSA; JUNTO CON LAS DE ARRIBA</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>MINUTES OF THE SHIFT</source>
      <translation>MINUTOS DEL TURNO</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>SHIFT FROM-TO, SUCH AS 6-14?</source>
      <translation>¿TURNO DE-A, COMO 6-14?</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>SPINDLE LOAD</source>
      <translation>CARGA DEL HUSILLO</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>SPINDLE LOAD, %</source>
      <translation>CARGA DEL HUSILLO, %</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>STOOD</source>
      <translation>PARADA</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>THE ARROWS CHOOSE A TREND; ESC GOES BACK TO THE LIST</source>
      <translation>LAS FLECHAS ELIGEN UNA TENDENCIA; ESC VUELVE A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>TRENDS</source>
      <translation>TENDENCIAS</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>TRENDS  ·  %1</source>
      <translation>TENDENCIAS  ·  %1</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>a shift is two hours of the day, such as 6-14</source>
      <translation>un turno son dos horas del día, como 6-14</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>cycle times, wear, stops, availability</source>
      <translation>ciclos, desgaste, paros, disponibilidad</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>last {last} %, highest {most} %</source>
      <translation>última {last} %, mayor {most} %</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>last {last}, shortest {best}, mean {mean} of {count} parts</source>
      <translation>último {last}, menor {best}, media {mean} de {count} piezas</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>no correction yet</source>
      <translation>aún sin correcciones</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>no drive of this machine tells its load</source>
      <translation>ningún accionamiento de esta máquina dice su carga</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>no part was made yet</source>
      <translation>aún no se ha hecho ninguna pieza</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>no stop yet</source>
      <translation>aún sin paros</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>parts</source>
      <translation>piezas</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>{count} corrections; last {offset}: X {x} Z {z} behind part {part}</source>
      <translation>{count} correcciones; última {offset}: X {x} Z {z} tras la pieza {part}</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>{count} stops, {mean} between them; {reason}: {time}</source>
      <translation>{count} paros, {mean} entre ellos; {reason}: {time}</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>{first}–{last}: the shift has not begun</source>
      <translation>{first}–{last}: el turno no ha empezado</translation>
    </message>
    <message>
      <location filename="app/quality/trends_section.py" />
      <source>{first}–{last}: {share} %, {run} of {planned}</source>
      <translation>{first}–{last}: {share} %, {run} de {planned}</translation>
    </message>
    <message>
      <location filename="app/quality/wear_correction.py" />
      <source>%1: no part begun since the last change of %2 is measured yet</source>
      <translation>%1: aún no se ha medido ninguna pieza empezada tras el último cambio de %2</translation>
    </message>
    <message>
      <location filename="app/quality/wear_correction.py" />
      <source>T{number} WAS NEVER SET</source>
      <translation>T{number} NUNCA FUE PUESTA</translation>
    </message>
    <message>
      <location filename="app/quality/wear_correction.py" />
      <source>measured {name}: mean {mean} of {count}, {change}</source>
      <translation>medido {name}: media {mean} de {count}, {change}</translation>
    </message>
    <message>
      <location filename="app/quality/wear_correction.py" />
      <source>{offset} {change}: {feature} {old} → {new}</source>
      <translation>{offset} {change}: {feature} {old} → {new}</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>%1 actual</source>
      <translation>%1 real</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>%1 demand</source>
      <translation>%1 consigna</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>%1 mm/m</source>
      <translation>%1 mm/m</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>A dash: the arc is too short to tell it.</source>
      <translation>Una raya: el arco es muy corto para saberlo.</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>BACKLASH {axis}</source>
      <translation>JUEGO {axis}</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>BALL BAR</source>
      <translation>BALL BAR</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>DEEPER</source>
      <translation>MÁS HONDO</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>ENTRY</source>
      <translation>ENTRADA</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>Entry angles lie within {angle}°</source>
      <translation>Los ángulos de entrada quedan en {angle}°</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>Greatest: {far}</source>
      <translation>Mayor: {far}</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>Infeed along a flank shifts the entry, by its depth.</source>
      <translation>El avance por un flanco corre la entrada, según su profundidad.</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>LEAD OFF</source>
      <translation>PASO ERRADO</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>Lead: {lead} a turn</source>
      <translation>Paso: {lead} por vuelta</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>Line {line}, arc {number} of {count}: radius {radius}, {angle}°</source>
      <translation>Línea {line}, arco {number} de {count}: radio {radius}, {angle}°</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>NOTHING IS RECORDED ON THIS MACHINE: OPEN A RECORD WITH F9</source>
      <translation>EN ESTA MÁQUINA NO SE REGISTRA NADA: ABRA UN REGISTRO CON F9</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>OFF THE PATH</source>
      <translation>FUERA DE TRAYECTORIA</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>OUT OF SQUARE</source>
      <translation>FUERA DE ESCUADRA</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>PASS</source>
      <translation>PASADA</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>PATH ERROR</source>
      <translation>ERROR DE TRAYECTORIA</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>Play behind the encoder is not seen by it.</source>
      <translation>El juego detrás del encoder no se ve en él.</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>Positive lies to the left of the way the tool goes.</source>
      <translation>Positivo queda a la izquierda del avance de la herramienta.</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>RADIUS OFF</source>
      <translation>RADIO ERRADO</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>RESPONSE</source>
      <translation>RESPUESTA</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>REVERSAL SPIKE {axis}</source>
      <translation>PICO DE INVERSIÓN {axis}</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>ROUNDNESS</source>
      <translation>REDONDEZ</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>RPM LOST</source>
      <translation>RPM PERDIDAS</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>SCALE {u} TO {v}</source>
      <translation>ESCALA {u} A {v}</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>THREAD</source>
      <translation>ROSCA</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>The slide can follow this lead up to {rpm} rpm</source>
      <translation>El carro puede seguir este paso hasta {rpm} rpm</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>WORKED OUT …</source>
      <translation>CALCULANDO …</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>asked and done of the last move, and its following error, over seconds</source>
      <translation>lo pedido y lo hecho del último movimiento, y su error de seguimiento, en segundos</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>error drawn {times} times as large; Z changes that</source>
      <translation>error dibujado {times} veces mayor; Z lo cambia</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>line {line}</source>
      <translation>línea {line}</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>passes over each other by the spindle's angle: way beside the thread, and speed</source>
      <translation>pasadas encimadas por el ángulo del husillo: desvío de la rosca, y velocidad</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>spindle speed</source>
      <translation>velocidad del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>spindle turns</source>
      <translation>vueltas del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>the record has no two slides, and so no path</source>
      <translation>el registro no tiene dos carros, y por eso no hay trayectoria</translation>
    </message>
    <message>
      <location filename="app/scope/analyses.py" />
      <source>there is no arc of 60 degrees or more in this time: record while a G02 or G03 is cut</source>
      <translation>en este tiempo no hay un arco de 60 grados o más: registre mientras se corta un G02 o G03</translation>
    </message>
    <message>
      <location filename="app/scope/analyses_view.py" />
      <source>ARROWS MARK A ROW; Z AND THE WHEEL MAGNIFY; THE SAME KEY AGAIN TAKES NEWER SAMPLES</source>
      <translation>LAS FLECHAS MARCAN UNA FILA; Z Y LA RUEDA AMPLÍAN; LA MISMA TECLA TOMA MUESTRAS NUEVAS</translation>
    </message>
    <message>
      <location filename="app/scope/analyses_view.py" />
      <source>NEXT ARC</source>
      <translation>OTRO ARC</translation>
    </message>
    <message>
      <location filename="app/scope/analyses_view.py" />
      <source>TEST</source>
      <translation>PRUEBA</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>%1 ms</source>
      <translation>%1 ms</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>A step of the Jog page is a good one; F9 has drive tests.</source>
      <translation>Un paso de la página Manual es bueno; F9 tiene pruebas.</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>AT {share} OF THE SPEED</source>
      <translation>A {share} DE LA VELOCIDAD</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>GREATEST ERROR</source>
      <translation>ERROR MAYOR</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>GREATEST SPEED</source>
      <translation>VELOCIDAD MAYOR</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>IN POSITION AFTER</source>
      <translation>EN POSICIÓN TRAS</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>LAG BEHIND THE SPEED</source>
      <translation>RETRASO POR VELOCIDAD</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>LAG MEETS WINDOW AT</source>
      <translation>EL RETRASO LLENA LA VENTANA A</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>NARROWEST THAT HOLDS</source>
      <translation>LA MÁS ESTRECHA QUE AGUANTA</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>OVERSHOOT</source>
      <translation>SOBREPASO</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>Of the last move of {axis}; worked out, nothing was changed.</source>
      <translation>Del último movimiento de {axis}; calculado, nada se cambió.</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>RISE, 10 TO 90 %</source>
      <translation>SUBIDA, 10 A 90 %</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>WAY</source>
      <translation>CAMINO</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>WINDOW AT THIS SPEED</source>
      <translation>VENTANA A ESTA VELOCIDAD</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>WITH {share} OF THE WINDOW</source>
      <translation>CON {share} DE LA VENTANA</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>holds</source>
      <translation>aguanta</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>no axis moved from rest to rest in this time: make a step on the Jog page</source>
      <translation>ningún eje se movió de reposo a reposo en este tiempo: haga un paso en la página Jog</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>no speed it has</source>
      <translation>ninguna velocidad que tenga</translation>
    </message>
    <message>
      <location filename="app/scope/axis_response.py" />
      <source>trips at {at}</source>
      <translation>dispara a los {at}</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>%1, %2 Hz</source>
      <translation>%1, %2 Hz</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>90° LATE</source>
      <translation>90° DE RETRASO</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>BANDWIDTH, −3 dB</source>
      <translation>ANCHO DE BANDA, −3 dB</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>GAIN</source>
      <translation>GANANCIA</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>LAG OF THE EVEN PART</source>
      <translation>RETRASO DE LA PARTE UNIFORME</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>LATE</source>
      <translation>RETRASO</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>LATE BY</source>
      <translation>RETRASADO EN</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>Nothing was written to the drive.</source>
      <translation>No se escribió nada en el accionamiento.</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>OUT</source>
      <translation>AFUERA</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>SPEED OVER LAG</source>
      <translation>VELOCIDAD ENTRE RETRASO</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>drive test</source>
      <translation>prueba de accionamiento</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>not up to {most} Hz</source>
      <translation>no hasta {most} Hz</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>the test was let go before its end: hold the key until it has come back</source>
      <translation>la prueba se soltó antes de su final: mantenga la tecla hasta que haya vuelto</translation>
    </message>
    <message>
      <location filename="app/scope/drive_test_figures.py" />
      <source>this machine has no axis {axis}</source>
      <translation>esta máquina no tiene eje {axis}</translation>
    </message>
    <message>
      <location filename="app/scope/record_shelf.py" />
      <source>%1 IS NOT WRITTEN: THE DISK IS FULL; DELETE RECORDS OR PROGRAMS</source>
      <translation>%1 NO SE HA ESCRITO: EL DISCO ESTÁ LLENO; BORRE REGISTROS O PROGRAMAS</translation>
    </message>
    <message>
      <location filename="app/scope/record_shelf.py" />
      <source>alarm time</source>
      <translation>hora de la alarma</translation>
    </message>
    <message>
      <location filename="app/scope/scope_function.py" />
      <source>CHANNELS</source>
      <translation>CANALES</translation>
    </message>
    <message>
      <location filename="app/scope/scope_function.py" />
      <source>NOTHING ON THIS MACHINE</source>
      <translation>NADA EN ESTA MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_function.py" />
      <source>PRESS RETURN FOR THE SCOPE; ESC GOES BACK TO THE LIST</source>
      <translation>PULSE RETURN PARA EL OSCILOSCOPIO; ESC VUELVE A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_function.py" />
      <source>RECORDED</source>
      <translation>SE REGISTRA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_function.py" />
      <source>Return opens the page; Shift+F10 does so from every page, and goes back.</source>
      <translation>Return abre la página; Mayús+F10 lo hace desde cualquier página, y regresa.</translation>
    </message>
    <message>
      <location filename="app/scope/scope_function.py" />
      <source>THE LAST {minutes} MINUTES</source>
      <translation>LOS ÚLTIMOS {minutes} MINUTOS</translation>
    </message>
    <message>
      <location filename="app/scope/scope_function.py" />
      <source>axes and spindle as curves</source>
      <translation>ejes y husillo como curvas</translation>
    </message>
    <message>
      <location filename="app/scope/scope_model.py" />
      <source>ARMED</source>
      <translation>ARMADO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_model.py" />
      <source>DELETED: {path}</source>
      <translation>BORRADO: {path}</translation>
    </message>
    <message>
      <location filename="app/scope/scope_model.py" />
      <source>PRESS Y TO DELETE {path}, ESC TO KEEP IT</source>
      <translation>PULSE Y PARA BORRAR {path}, ESC PARA CONSERVARLO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_model.py" />
      <source>THE CURVES ARE LIVE: PRESS F2 TO FREEZE THEM FIRST</source>
      <translation>LAS CURVAS CORREN: PRIMERO CONGÉLELAS CON F2</translation>
    </message>
    <message>
      <location filename="app/scope/scope_model.py" />
      <source>THE RECORD IS EMPTY: NOTHING WAS SAMPLED IN THAT TIME</source>
      <translation>EL REGISTRO ESTÁ VACÍO: NO SE MUESTREÓ NADA EN ESE TIEMPO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_model.py" />
      <source>TRIGGER HELD: F2 ARMS IT</source>
      <translation>DISPARO RETENIDO: F2 LO ARMA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_model.py" />
      <source>TRIGGERED</source>
      <translation>DISPARADO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_model.py" />
      <source>{most} CURVES ARE SHOWN, AND NO MORE CAN BE TOLD APART: TAKE ONE AWAY FIRST</source>
      <translation>SE MUESTRAN {most} CURVAS Y NO SE DISTINGUEN MÁS: QUITE UNA PRIMERO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_readings_view.py" />
      <source>B − A   %1 ms</source>
      <translation>B − A   %1 ms</translation>
    </message>
    <message>
      <location filename="app/scope/scope_readings_view.py" />
      <source>F4 chooses curves.</source>
      <translation>F4 elige curvas.</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>ARROWS MOVE THE CURSOR, TAB TAKES THE OTHER; Z ZOOMS, CTRL+ARROWS PAN AND STRETCH</source>
      <translation>LAS FLECHAS MUEVEN EL CURSOR, TAB TOMA EL OTRO; Z AMPLÍA, CTRL+FLECHAS DESPLAZAN Y ESTIRAN</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>CURVES</source>
      <translation>CURVAS</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>F2 SAVES WHAT IS SEEN; RETURN OPENS A RECORD; ESC GOES BACK TO THE CURVES</source>
      <translation>F2 GUARDA LO QUE SE VE; RETURN ABRE UN REGISTRO; ESC VUELVE A LAS CURVAS</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>LEVEL</source>
      <translation>NIVEL</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>LEVEL?</source>
      <translation>¿NIVEL?</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>LIES IN THE WINDOW AT</source>
      <translation>EN LA VENTANA QUEDA AL</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>LINE?</source>
      <translation>¿LÍNEA?</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>No record is kept yet: F2 saves what is seen.</source>
      <translation>Aún no hay registros: F2 guarda lo que se ve.</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>OVERLAY</source>
      <translation>ENCIMA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>RECORDS</source>
      <translation>REGISTROS</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>RELEASED BY</source>
      <translation>LO SUELTA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>RETURN GOES ON TO THE NEXT CHOICE; A LEVEL IS TYPED; ESC GOES BACK TO THE CURVES</source>
      <translation>RETURN PASA A LA OPCIÓN SIGUIENTE; EL NIVEL SE ESCRIBE; ESC VUELVE A LAS CURVAS</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>RETURN SHOWS THE MARKED CURVE, OR TAKES IT AWAY; ESC GOES BACK TO THE CURVES</source>
      <translation>RETURN MUESTRA LA CURVA MARCADA O LA QUITA; ESC VUELVE A LAS CURVAS</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>SIGNAL</source>
      <translation>SEÑAL</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>TRIGGER</source>
      <translation>DISPARO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>UP AND DOWN CHOOSE A CURVE; Z ZOOMS, CTRL+ARROWS PAN AND STRETCH; F2 FREEZES</source>
      <translation>ARRIBA Y ABAJO ELIGEN UNA CURVA; Z AMPLÍA, CTRL+FLECHAS DESPLAZAN Y ESTIRAN; F2 CONGELA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>Velocities and ripple are taken over a span: it stands beside them.</source>
      <translation>Velocidades y rizado se toman en un lapso: está junto a ellos.</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>WRITTEN</source>
      <translation>ESCRITO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>When it is released the curves are frozen: once.</source>
      <translation>Al soltarse se congelan las curvas: una vez.</translation>
    </message>
    <message>
      <location filename="app/scope/scope_sheets.py" />
      <source>a line of the program is a whole number from 1 on</source>
      <translation>una línea del programa es un número entero desde 1</translation>
    </message>
    <message>
      <location filename="app/scope/scope_trigger.py" />
      <source>A LINE OF THE PROGRAM BEGINS</source>
      <translation>EMPIEZA UNA LÍNEA DEL PROGRAMA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_trigger.py" />
      <source>AN ALARM OR E-STOP</source>
      <translation>UNA ALARMA O PARO DE EMERGENCIA</translation>
    </message>
    <message>
      <location filename="app/scope/scope_trigger.py" />
      <source>FALLS THROUGH A LEVEL</source>
      <translation>BAJA POR UN NIVEL</translation>
    </message>
    <message>
      <location filename="app/scope/scope_trigger.py" />
      <source>GOES BEYOND ± A LEVEL</source>
      <translation>PASA DE ± UN NIVEL</translation>
    </message>
    <message>
      <location filename="app/scope/scope_trigger.py" />
      <source>OFF: THE CURVES ROLL</source>
      <translation>APAGADO: LAS CURVAS CORREN</translation>
    </message>
    <message>
      <location filename="app/scope/scope_trigger.py" />
      <source>RISES THROUGH A LEVEL</source>
      <translation>SUBE POR UN NIVEL</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>CURSORS</source>
      <translation>CURSORES</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>FREEZE</source>
      <translation>CONGELAR</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>FROZEN</source>
      <translation>CONGELADO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>LIVE</source>
      <translation>EN VIVO</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>OPENING …</source>
      <translation>ABRIENDO …</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>PICTURE</source>
      <translation>IMAGEN</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>over it {name}</source>
      <translation>encima {name}</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>window {span}</source>
      <translation>ventana {span}</translation>
    </message>
    <message>
      <location filename="app/scope/scope_view.py" />
      <source>{rate} samples a second</source>
      <translation>{rate} muestras por segundo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>%1 acceleration</source>
      <translation>%1 aceleración</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>%1 demand velocity</source>
      <translation>%1 velocidad de consigna</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>%1 following error</source>
      <translation>%1 error de seguimiento</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>%1 load</source>
      <translation>%1 carga</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>%1 velocity</source>
      <translation>%1 velocidad</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>ACCELERATION</source>
      <translation>ACELERACIÓN</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>ANGLE</source>
      <translation>ÁNGULO</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>FOLLOWING ERROR</source>
      <translation>ERROR DE SEGUIMIENTO</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Feed override</source>
      <translation>Sobremando de avance</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>INPUTS AND OUTPUTS</source>
      <translation>ENTRADAS Y SALIDAS</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>LATENESS</source>
      <translation>RETRASO</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>LOAD</source>
      <translation>CARGA</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Lateness</source>
      <translation>Retraso del control</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Line</source>
      <translation>Línea</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>OVERRIDE</source>
      <translation>SOBREMANDO</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>QUEUE</source>
      <translation>COLA</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Queue depth</source>
      <translation>Cola de consignas</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>SPINDLE RIPPLE</source>
      <translation>RIZADO DEL HUSILLO</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>SPINDLE TURNS</source>
      <translation>VUELTAS DEL HUSILLO</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Spindle commanded</source>
      <translation>Husillo mandado</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Spindle load</source>
      <translation>Carga del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Spindle measured</source>
      <translation>Husillo medido</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Spindle override</source>
      <translation>Sobremando de husillo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Spindle ripple</source>
      <translation>Rizado del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>Spindle turns</source>
      <translation>Vueltas del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>TURNING ACCELERATION</source>
      <translation>ACELERACIÓN DE GIRO</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>TURNING SPEED</source>
      <translation>VELOCIDAD DE GIRO</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>VELOCITY</source>
      <translation>VELOCIDAD</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>acceleration</source>
      <translation>aceleración</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>commanded</source>
      <translation>mandada</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>feed override</source>
      <translation>regulación del avance</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>following error</source>
      <translation>error de seguimiento</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>load</source>
      <translation>carga</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>measured</source>
      <translation>medida</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>over {ms} ms</source>
      <translation>en {ms} ms</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>spindle command</source>
      <translation>consigna del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>spindle load</source>
      <translation>carga del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>spindle override</source>
      <translation>regulación del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>spindle ripple</source>
      <translation>rizado del husillo</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>turns</source>
      <translation>vueltas</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>velocity</source>
      <translation>velocidad</translation>
    </message>
    <message>
      <location filename="app/scope/signals.py" />
      <source>velocity commanded</source>
      <translation>velocidad mandada</translation>
    </message>
    <message>
      <location filename="app/screen/alarm_panels.py" />
      <source>ALARMS AND STOPS  ·  ESC CLOSES  ·  CTRL+ARROWS MARK  ·  SHIFT+F10: ITS RECORD</source>
      <translation>ALARMAS Y PAROS  ·  ESC CIERRA  ·  CTRL+FLECHAS MARCAN  ·  MAYÚS+F10: SU REGISTRO</translation>
    </message>
    <message>
      <location filename="app/screen/alarm_panels.py" />
      <source>ALSO: %1</source>
      <translation>TAMBIÉN: %1</translation>
    </message>
    <message>
      <location filename="app/screen/alarm_panels.py" />
      <source>CAUSE, THE LIKELIEST FIRST</source>
      <translation>CAUSA, LA MÁS PROBABLE PRIMERO</translation>
    </message>
    <message>
      <location filename="app/screen/alarm_panels.py" />
      <source>LINE %1</source>
      <translation>LÍNEA %1</translation>
    </message>
    <message>
      <location filename="app/screen/alarm_panels.py" />
      <source>No alarm and no stop yet.</source>
      <translation>Todavía ninguna alarma ni paro.</translation>
    </message>
    <message>
      <location filename="app/screen/alarm_panels.py" />
      <source>WHAT TO DO</source>
      <translation>QUÉ HACER</translation>
    </message>
    <message>
      <location filename="app/screen/alarm_panels.py" />
      <source>line %1</source>
      <translation>línea %1</translation>
    </message>
    <message>
      <location filename="app/screen/entry_panel.py" />
      <source>DEL</source>
      <translation>BORRAR</translation>
    </message>
    <message>
      <location filename="app/screen/entry_panel.py" />
      <source>RETURN</source>
      <translation>RETURN</translation>
    </message>
    <message>
      <location filename="app/screen/language.py" />
      <source>there is no catalogue turndesk_%1.qm in %2</source>
      <translation>no hay catálogo turndesk_%1.qm en %2</translation>
    </message>
    <message>
      <location filename="app/screen/letter_keys.py" />
      <source>SPACE</source>
      <translation>ESPACIO</translation>
    </message>
    <message>
      <location filename="app/screen/main_menu.py" />
      <source>PRESS A FUNCTION KEY OR TOUCH A PAGE; ESC FOR AUTOMATIC</source>
      <translation>OPRIMA UNA TECLA DE FUNCIÓN O TOQUE UNA PÁGINA; ESC A AUTOMÁTICO</translation>
    </message>
    <message>
      <location filename="app/screen/main_window.py" />
      <source>A PROGRAM IS UNDER WAY: STOP IT AND PRESS R BEFORE LEAVING</source>
      <translation>HAY UN PROGRAMA EN CURSO: PÁRELO Y OPRIMA R ANTES DE SALIR</translation>
    </message>
    <message>
      <location filename="app/screen/main_window.py" />
      <source>AN ENTRY HAS THE KEYBOARD, AND DOES NOT TAKE {key} HERE</source>
      <translation>UN CAMPO TIENE EL TECLADO, Y NO ADMITE {key} AQUÍ</translation>
    </message>
    <message>
      <location filename="app/screen/main_window.py" />
      <source>THE SCREEN STOOD STILL FOR {seconds} S: WHAT WAS PRESSED MEANWHILE WAS FORGOTTEN</source>
      <translation>LA PANTALLA ESTUVO DETENIDA {seconds} S: LO OPRIMIDO MIENTRAS TANTO SE OLVIDÓ</translation>
    </message>
    <message>
      <location filename="app/screen/main_window.py" />
      <source>{key} HAS NO FUNCTION ON THIS PAGE</source>
      <translation>{key} NO TIENE FUNCIÓN EN ESTA PÁGINA</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>ANALYSES</source>
      <translation>ANÁLISIS</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>AUTOMATIC</source>
      <translation>AUTOMÁTICO</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>D1…D32: corrections of wear and size</source>
      <translation>D1…D32: correcciones de desgaste y medida</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>EDITOR</source>
      <translation>EDITOR</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>G54…G59: where SINUMERIK programs have their zero</source>
      <translation>G54…G59: dónde tienen su cero los programas SINUMERIK</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>LIST</source>
      <translation>LISTA</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>MAIN MENU</source>
      <translation>MENÚ PRINCIPAL</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>MDI</source>
      <translation>MDI</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>PROGRAMS</source>
      <translation>PROGRAMAS</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>SECONDARY OFFSETS</source>
      <translation>COMPENSACIÓN SECUNDARIA</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>SPECIAL FUNCTIONS</source>
      <translation>FUNCIONES ESPECIALES</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>T1…T32: position and nose radius</source>
      <translation>T1…T32: posición y radio de punta</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>TOOL SHAPE</source>
      <translation>FORMA DE HERRAMIENTA</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>ZERO OFFSETS</source>
      <translation>CEROS DE PIEZA</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>axes and spindle as curves: following error, speed, load</source>
      <translation>ejes y husillo como curvas: error de seguimiento, velocidad, carga</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>findings of the program, its stock, silenced checks</source>
      <translation>avisos del programa, su material, comprobaciones silenciadas</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>list, preview, copy, import and export</source>
      <translation>lista, vista previa, copiar, importar y exportar</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>move by hand, touch tools off</source>
      <translation>mover a mano, tocar herramientas</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>one line at a time</source>
      <translation>una línea a la vez</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>readings, charts, wear, tool life, trends</source>
      <translation>lecturas, gráficos, desgaste, vida de herramienta, tendencias</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>run programs</source>
      <translation>correr programas</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>speed limit, parts, inputs and outputs, log, backup</source>
      <translation>tope de velocidad, piezas, entradas y salidas, bitácora, respaldo</translation>
    </message>
    <message>
      <location filename="app/screen/page_table.py" />
      <source>write and prove programs</source>
      <translation>escribir y comprobar programas</translation>
    </message>
    <message>
      <location filename="app/screen/program_listing.py" />
      <source>%1  ·  HOME FOLLOWS AGAIN</source>
      <translation>%1  ·  INICIO VUELVE A SEGUIR</translation>
    </message>
    <message>
      <location filename="app/screen/program_listing.py" />
      <source>BLOCK</source>
      <translation>BLOQUE</translation>
    </message>
    <message>
      <location filename="app/screen/program_listing.py" />
      <source>No program.</source>
      <translation>Sin programa.</translation>
    </message>
    <message>
      <location filename="app/screen/program_listing.py" />
      <source>PROGRAM  ·  %1 LINES</source>
      <translation>PROGRAMA  ·  %1 LÍNEAS</translation>
    </message>
    <message>
      <location filename="app/screen/readout_panels.py" />
      <source>ACTUAL</source>
      <translation>REAL</translation>
    </message>
    <message>
      <location filename="app/screen/readout_panels.py" />
      <source>FEED %1</source>
      <translation>AVANCE %1</translation>
    </message>
    <message>
      <location filename="app/screen/readout_panels.py" />
      <source>LAST KNOWN</source>
      <translation>ÚLTIMO CONOCIDO</translation>
    </message>
    <message>
      <location filename="app/screen/readout_panels.py" />
      <source>PRESS E-STOP</source>
      <translation>PULSE PARO DE EMERGENCIA</translation>
    </message>
    <message>
      <location filename="app/screen/readout_panels.py" />
      <source>SPINDLE %1</source>
      <translation>HUSILLO %1</translation>
    </message>
    <message>
      <location filename="app/screen/readout_panels.py" />
      <source>SPINDLE MAY TURN</source>
      <translation>PUEDE GIRAR</translation>
    </message>
    <message>
      <location filename="app/screen/readout_panels.py" />
      <source>STOP %1: %2</source>
      <translation>PARO %1: %2</translation>
    </message>
    <message>
      <location filename="app/screen/readout_panels.py" />
      <source>SWITCH OFF</source>
      <translation>APAGADO</translation>
    </message>
    <message>
      <location filename="app/screen/run_screen.py" />
      <source>A MISTAKE OF THE SCREEN; THE MACHINE IS NOT CONCERNED: %1: %2</source>
      <translation>UN ERROR DE LA PANTALLA; LA MÁQUINA NO TIENE QUE VER: %1: %2</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>CYCLE START</source>
      <translation>INICIO DE CICLO</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>CYCLE START: BOTH PALMS</source>
      <translation>INICIO DE CICLO: DOS PALMAS</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>FEED HOLD</source>
      <translation>RETENCIÓN DE AVANCE</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>FEED RATE</source>
      <translation>AVANCE</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>IS IN</source>
      <translation>OPRIMIDO</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>OPERATOR STATION</source>
      <translation>ESTACIÓN DEL OPERADOR</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>PAUSE</source>
      <translation>PAUSA</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>SCR LOCK</source>
      <translation>BLOQ DES</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>SPINDLE SPEED</source>
      <translation>VELOC DE HUSILLO</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>SPINDLE SWITCH</source>
      <translation>INTERRUPTOR HUSILLO</translation>
    </message>
    <message>
      <location filename="app/screen/station_dock.py" />
      <source>TWIST</source>
      <translation>GIRE</translation>
    </message>
    <message>
      <location filename="app/screen/window_bars.py" />
      <source>STARTING</source>
      <translation>ARRANCANDO</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>%1 TO GO ON</source>
      <translation>%1 PARA SEGUIR</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>CYCLE</source>
      <translation>CICLO</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>DRIVES ON</source>
      <translation>SERVOS ACTIVOS</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>HELD IN MEMORY, WRITTEN WHEN THERE IS ROOM: {what}</source>
      <translation>EN MEMORIA, SE ESCRIBE CUANDO HAYA ESPACIO: {what}</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>LAST</source>
      <translation>ÚLTIMO</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>NOT KEPT</source>
      <translation>SIN GUARDAR</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>NOTHING WAS RECORDED BEFORE THIS ONE: ALARMS AND E-STOPS HAVE A RECORD</source>
      <translation>ANTES DE ÉSTE NO SE REGISTRÓ NADA: LAS ALARMAS Y LOS PAROS DE EMERGENCIA TIENEN REGISTRO</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>PARTS  ·  TIME</source>
      <translation>PIEZAS  ·  TIEMPO</translation>
    </message>
    <message>
      <location filename="app/screen/window_frame.py" />
      <source>TOOL  ·  OFFSET</source>
      <translation>HERRAMIENTA  ·  COMPENSACIÓN</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>(WAY OUT OF THE PART)</source>
      <translation>(SALIDA DE LA PIEZA)</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>A PROGRAM IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R, BEFORE SEARCHTO</source>
      <translation>HAY UN PROGRAMA EN CURSO: DEJE QUE TERMINE, O PÁRELO Y OPRIMA R, ANTES DE BUSCAR A</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>CHOOSE A GOOD LINE FIRST</source>
      <translation>ELIJA PRIMERO UNA LÍNEA BUENA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>CHOOSE A PROGRAM FIRST (F2)</source>
      <translation>ELIJA PRIMERO UN PROGRAMA (F2)</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>COMPARE; LOOK AT THE WAY AND AT WHAT WILL START; F10 CONFIRMS</source>
      <translation>COMPARE; VEA EL CAMINO Y LO QUE ARRANCARÁ; F10 CONFIRMA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>ENTER FIRST; ONLY A LINE IN A LOOP OR A SUBROUTINE HAS PASSES</source>
      <translation>PRIMERO ENTER; SÓLO TIENE PASADAS UNA LÍNEA DE UN LAZO O DE UNA SUBRUTINA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>GOING THROUGH THE PROGRAM; ESC GIVES UP</source>
      <translation>RECORRIENDO EL PROGRAMA; ESC ABANDONA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>LINE {line} WAS RUNNING WHEN THE PROGRAM BROKE OFF; ENTER REBUILDS ITS STATE, F4 ONLY LEADS OUT</source>
      <translation>LA LÍNEA {line} CORRÍA AL INTERRUMPIRSE EL PROGRAMA; ENTER RECONSTRUYE SU ESTADO, F4 SÓLO SACA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>LOOK AT THE WAY OUT OF THE PART; F10 CONFIRMS IT</source>
      <translation>VEA EL CAMINO DE SALIDA DE LA PIEZA; F10 LO CONFIRMA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>NO START FROM THIS LINE: F8 OR F9 GOES TO THE NEAREST GOOD ONE</source>
      <translation>DESDE ESTA LÍNEA NO ARRANCA: F8 O F9 VA A LA BUENA MÁS CERCANA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>NO START: SEARCH A LINE AND CONFIRM IT FIRST (F10)</source>
      <translation>NO ARRANCA: BUSQUE PRIMERO UNA LÍNEA Y CONFÍRMELA (F10)</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>PROVING THE RESTART; ESC GIVES UP</source>
      <translation>COMPROBANDO EL REARRANQUE; ESC ABANDONA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>SEARCHTO READS OMNITURN PROGRAMS ONLY; THIS ONE STARTS FROM ITS FIRST LINE</source>
      <translation>BUSCAR A LEE SÓLO PROGRAMAS OMNITURN; ÉSTE ARRANCA DESDE SU PRIMERA LÍNEA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>SWITCH THE DRIVES ON FIRST (D)</source>
      <translation>ENCIENDA PRIMERO LOS SERVOS (D)</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>THE LINE CANNOT BE SEARCHED: {why}</source>
      <translation>LA LÍNEA NO SE PUEDE BUSCAR: {why}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>THE PROGRAM IS NOT PROVED WITHOUT ERRORS: SEARCHTO NEEDS THAT</source>
      <translation>EL PROGRAMA NO ESTÁ COMPROBADO SIN ERRORES: BUSCAR A LO NECESITA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>TO START THE RESTART {start}; ESC TAKES IT BACK</source>
      <translation>PARA INICIAR EL REARRANQUE {start}; ESC LO RETIRA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>TO TAKE THE TOOL OUT OF THE PART {start}; ESC TAKES IT BACK</source>
      <translation>PARA SACAR LA HERRAMIENTA DE LA PIEZA {start}; ESC LO ANULA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>TYPE A LINE NUMBER OR A TEXT, OR CHOOSE BY THE ARROWS; ENTER REBUILDS THE STATE</source>
      <translation>ESCRIBA UN NÚMERO DE LÍNEA O UN TEXTO, O ELIJA CON FLECHAS; ENTER RECONSTRUYE EL ESTADO</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>TYPE A TEXT FIRST; A QUOTATION MARK BEFORE FIGURES MAKES THEM ONE</source>
      <translation>ESCRIBA PRIMERO UN TEXTO; COMILLAS ANTES DE LAS CIFRAS LAS VUELVEN TEXTO</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>WAY OUT</source>
      <translation>SALIDA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>WILL NOT START: {why}</source>
      <translation>NO ARRANCARÁ: {why}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_model.py" />
      <source>{text} IS IN NO LINE</source>
      <translation>{text} NO ESTÁ EN NINGUNA LÍNEA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>C HAS TURNED SINCE T{tool} WENT IN: TURN THE SPINDLE FREE BY HAND AND JOG T{tool} OUT</source>
      <translation>C GIRÓ DESDE QUE ENTRÓ T{tool}: LIBÉRELA GIRANDO EL HUSILLO A MANO Y SAQUE T{tool} A MANO</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>CALLED ON LINE</source>
      <translation>LLAMADA EN LA LÍNEA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>HOW T{tool} CAME TO STAND HERE IS NOT KNOWN: JOG IT CLEAR OF THE PART BY THE WAY IT CAME</source>
      <translation>NO SE SABE CÓMO LLEGÓ AQUÍ T{tool}: SÁQUELA A MANO DE LA PIEZA POR DONDE ENTRÓ</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>LOOK: LINES {first} TO {last} ARE LEFT OUT AND THEIR METAL IS STILL THERE</source>
      <translation>OJO: SE OMITEN LAS LÍNEAS {first} A {last} Y SU METAL SIGUE AHÍ</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>PASS OF LINES {first}-{last}</source>
      <translation>PASADA DE LAS LÍNEAS {first}-{last}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>SPINDLE FORWARD</source>
      <translation>HUSILLO ADELANTE</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>SPINDLE LOCKED AS C, TURNED TO ITS ANGLE</source>
      <translation>HUSILLO BLOQUEADO COMO C, GIRADO A SU ÁNGULO</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>SPINDLE REVERSE</source>
      <translation>HUSILLO REVERSA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>THE COLLET IS CLOSED AND MUST BE OPEN AT THIS LINE: M13 IN MDI</source>
      <translation>LA BOQUILLA ESTÁ CERRADA Y DEBE ESTAR ABIERTA EN ESTA LÍNEA: M13 EN MDI</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>THE COLLET IS OPEN AND MUST BE CLOSED AT THIS LINE: M12 IN MDI</source>
      <translation>LA BOQUILLA ESTÁ ABIERTA Y DEBE ESTAR CERRADA EN ESTA LÍNEA: M12 EN MDI</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>T{tool} IS A TAP IN ITS THREAD: TURN IT OUT BY HAND WITH THE SPINDLE, Z FOLLOWING</source>
      <translation>T{tool} ES UN MACHUELO EN SU ROSCA: SÁQUELO A MANO GIRANDO EL HUSILLO, CON Z DETRÁS</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>T{tool} STANDS CLEAR OF THE PART ALREADY</source>
      <translation>T{tool} YA ESTÁ FUERA DE LA PIEZA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>T{tool} STANDS IN A THREAD: JOG X OFF THE THREAD FIRST, NOT Z</source>
      <translation>T{tool} ESTÁ EN UNA ROSCA: SAQUE PRIMERO X DE LA ROSCA A MANO, NO Z</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>T{tool} STANDS IN THE PART: JOG IT OUT BY THE WAY IT CAME, {x} AND Z+ TOGETHER</source>
      <translation>T{tool} ESTÁ EN LA PIEZA: SÁQUELA A MANO POR DONDE ENTRÓ, {x} Y Z+ A LA VEZ</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>T{tool} STANDS IN THE PART: JOG Z+ OUT OF IT FIRST, NOT X</source>
      <translation>T{tool} ESTÁ EN LA PIEZA: SÁQUELA PRIMERO A MANO EN Z+, NO EN X</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>T{tool} STANDS IN THE PART: JOG {x} OUT OF IT FIRST, NOT Z</source>
      <translation>T{tool} ESTÁ EN LA PIEZA: SÁQUELA PRIMERO A MANO EN {x}, NO EN Z</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>{name} ON</source>
      <translation>{name} ENCENDIDO</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_plan.py" />
      <source>{number} OF {count}</source>
      <translation>{number} DE {count}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_state_view.py" />
      <source>AT THE LINE</source>
      <translation>EN LA LÍNEA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_state_view.py" />
      <source>Pass after</source>
      <translation>Pasada sig.</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_state_view.py" />
      <source>Pass before</source>
      <translation>Pasada ant.</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>CONFIRM</source>
      <translation>CONFIRMA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>CONFIRMED: CYCLE START BEGINS IT</source>
      <translation>CONFIRMADO: INICIO DE CICLO LO ARRANCA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>ENTER REBUILDS THE STATE OF LINE {line}</source>
      <translation>ENTER RECONSTRUYE EL ESTADO DE LA LÍNEA {line}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>F5: WITH COOLANT</source>
      <translation>F5: CON REFRIGERANTE</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>F5: WITHOUT COOLANT</source>
      <translation>F5: SIN REFRIGERANTE</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>GOING THROUGH THE PROGRAM TO LINE {line}</source>
      <translation>RECORRIENDO EL PROGRAMA HASTA LA LÍNEA {line}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>GOOD AFTER</source>
      <translation>BUENA DESPUÉS</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>GOOD BEFORE</source>
      <translation>BUENA ANTES</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>H HOLDS IT ON ITS WAY</source>
      <translation>H LA RETIENE EN SU CAMINO</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>LINE OR TEXT?</source>
      <translation>¿LÍNEA O TEXTO?</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>LINE {line} IS NOT GOOD</source>
      <translation>LA LÍNEA {line} NO ES BUENA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>NOTHING BUT THE SLIDES</source>
      <translation>NADA MÁS LOS CARROS</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>PASS {number} OF {count}</source>
      <translation>PASADA {number} DE {count}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>PREVIOUS</source>
      <translation>PREVIA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>SEARCH</source>
      <translation>BUSCAR</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>STATE AT LINE {line}</source>
      <translation>ESTADO EN LA LÍNEA {line}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>THE TOOL LEAVES THE PART AT {feed}</source>
      <translation>LA HERRAMIENTA SALE DE LA PIEZA A {feed}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>THE WAY OUT OF THE PART</source>
      <translation>CAMINO DE SALIDA DE LA PIEZA</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>WILL START</source>
      <translation>ARRANCARÁ</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>{which}: LINE {line}</source>
      <translation>{which}: LÍNEA {line}</translation>
    </message>
    <message>
      <location filename="app/searchto/searchto_view.py" />
      <source>{which}: NONE</source>
      <translation>{which}: NINGUNA</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>%1 KB</source>
      <translation>%1 KB</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>A PROGRAM IS UNDER WAY: NOTHING IS RESTORED BEFORE IT HAS ENDED</source>
      <translation>HAY UN PROGRAMA EN CURSO: NO SE RESTAURA NADA ANTES DE QUE TERMINE</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>BACKUP AND RESTORE</source>
      <translation>RESPALDO Y RESTAURACIÓN</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>BACKUP TO HERE</source>
      <translation>RESPALDAR AQUÍ</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>BACKUP {name} IS WHOLE AND ON THE DISK: A STICK MAY BE REMOVED</source>
      <translation>EL RESPALDO {name} ESTÁ COMPLETO Y EN EL DISCO: YA PUEDE SACAR LA MEMORIA</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>Backing up …</source>
      <translation>Respaldando …</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>PRESS Y TO RESTORE {name} OVER EVERYTHING KEPT NOW, ESC TO LEAVE IT</source>
      <translation>OPRIMA Y PARA RESTAURAR {name} SOBRE TODO LO GUARDADO, ESC PARA DEJARLO</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>RESTORED; WHAT WAS THERE BEFORE IS KEPT AS {name}</source>
      <translation>RESTAURADO; LO QUE HABÍA ANTES SE GUARDA COMO {name}</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>RETURN DOES</source>
      <translation>RETURN HACE</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>RETURN ON A PLACE BACKS UP, ON A BACKUP RESTORES IT; F4 LOOKS FOR STICKS AGAIN</source>
      <translation>RETURN SOBRE UN LUGAR RESPALDA, SOBRE UN RESPALDO LO RESTAURA; F4 BUSCA MEMORIAS OTRA VEZ</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>Restoring …</source>
      <translation>Restaurando …</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>WHEN</source>
      <translation>CUÁNDO</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>What a restore replaces is kept beside it.</source>
      <translation>Lo que una restauración reemplaza se guarda al lado.</translation>
    </message>
    <message>
      <location filename="app/special/backup_and_restore.py" />
      <source>offsets, versions, counts, settings, log</source>
      <translation>compensaciones, versiones, ajustes</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>ALLOWED</source>
      <translation>PERMITIDO</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>AXIS</source>
      <translation>EJE</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>DEMAND</source>
      <translation>CONSIGNA</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>DRIVE STATUS</source>
      <translation>ESTADO DE SERVOS</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>DRIVE STATUS  ·  %1  ·  %2</source>
      <translation>ESTADO DE SERVOS  ·  %1  ·  %2</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>F7 LISTS THE ALARMS WITH CAUSE AND REMEDY; ESC GOES BACK TO THE LIST</source>
      <translation>F7 MUESTRA LAS ALARMAS CON CAUSA Y REMEDIO; ESC REGRESA A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>FAULT</source>
      <translation>FALLA</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>FOLLOWING</source>
      <translation>SEGUIMIENTO</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>Largest following error since the start: %1</source>
      <translation>Mayor error de seguimiento desde el arranque: %1</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>ON</source>
      <translation>ENCENDIDO</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>POWER</source>
      <translation>POTENCIA</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>Setpoint queue ran low: %1 times</source>
      <translation>La cola de consignas quedó corta: %1 veces</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>X IS A RADIUS FROM HOME</source>
      <translation>X ES RADIO DESDE LA REFERENCIA</translation>
    </message>
    <message>
      <location filename="app/special/drive_status.py" />
      <source>power, home, following error, faults</source>
      <translation>potencia, referencia, error, fallas</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>ALARM</source>
      <translation>ALARMA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>ASKED BY</source>
      <translation>LA LEE</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>AXES HOMED</source>
      <translation>EJES REFERENCIADOS</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>F4 SHOWS THE NEXT LIST; ESC GOES BACK TO THE LIST OF FUNCTIONS</source>
      <translation>F4 MUESTRA LA LISTA SIGUIENTE; ESC REGRESA A LA LISTA DE FUNCIONES</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>GUARD</source>
      <translation>GUARDA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>LAMP</source>
      <translation>LÁMPARA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>LAMPS</source>
      <translation>LÁMPARAS</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>MACHINE LAMPS</source>
      <translation>LÁMPARAS DE LA MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>ONLY OUTPUTS CAN BE SWITCHED; F4 SHOWS THEM</source>
      <translation>SÓLO SE PUEDEN CAMBIAR LAS SALIDAS; F4 LAS MUESTRA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>OUTPUTS ARE SWITCHED BY HAND ONLY WHILE NO PROGRAM IS UNDER WAY AND NOTHING MOVES</source>
      <translation>LAS SALIDAS SÓLO SE CAMBIAN A MANO SIN PROGRAMA EN CURSO Y SIN QUE NADA SE MUEVA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>PRESS Y TO SWITCH {name} OFF, ESC TO LEAVE IT ON</source>
      <translation>OPRIMA Y PARA APAGAR {name}, ESC PARA DEJARLA ENCENDIDA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>PRESS Y TO SWITCH {name} ON, ESC TO LEAVE IT OFF</source>
      <translation>OPRIMA Y PARA ENCENDER {name}, ESC PARA DEJARLA APAGADA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>RETURN SWITCHES THE MARKED OUTPUT BY HAND: LOOK AT THE MACHINE FIRST</source>
      <translation>RETURN CAMBIA A MANO LA SALIDA MARCADA: MIRE PRIMERO LA MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>STATE</source>
      <translation>ESTADO</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>SWITCHED BY</source>
      <translation>LA CAMBIA</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>TERMINAL</source>
      <translation>TERMINAL</translation>
    </message>
    <message>
      <location filename="app/special/inputs_outputs.py" />
      <source>live state, outputs by hand, lamps</source>
      <translation>estado, salidas a mano, lámparas</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>%1 EVENTS</source>
      <translation>%1 EVENTOS</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>EVENT LOG</source>
      <translation>BITÁCORA</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>EVENT LOG  ·  %1  ·  %2</source>
      <translation>BITÁCORA  ·  %1  ·  %2</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>F4 SEARCHES, F5 SHOWS ANOTHER KIND; PAGE UP AND PAGE DOWN LOOK ON; ESC GOES BACK</source>
      <translation>F4 BUSCA, F5 MUESTRA OTRA CLASE; RE PÁG Y AV PÁG SIGUEN; ESC REGRESA</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>FILTER</source>
      <translation>FILTRO</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>OPERATOR</source>
      <translation>OPERADOR</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>RUNS</source>
      <translation>CORRIDAS</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>SEARCH FOR?</source>
      <translation>¿QUÉ BUSCAR?</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>THE LAST %1 EVENTS</source>
      <translation>LOS ÚLTIMOS %1 EVENTOS</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>TYPE WHAT TO LOOK FOR; RETURN KEEPS IT, ESC TAKES IT AWAY</source>
      <translation>ESCRIBA QUÉ BUSCAR; RETURN LO CONSERVA, ESC LO QUITA</translation>
    </message>
    <message>
      <location filename="app/special/logged_events.py" />
      <source>what happened when; search</source>
      <translation>qué pasó y cuándo; buscar</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>A CHANGED MACHINE FILE IS ACCEPTED WITH THE DRIVES OFF</source>
      <translation>UN ARCHIVO DE MÁQUINA CAMBIADO SE ACEPTA CON LOS SERVOS APAGADOS</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>ACCEPT</source>
      <translation>ACEPTAR</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>ACCEPTED: THE DRIVES CAN BE SWITCHED ON</source>
      <translation>ACEPTADO: SE PUEDEN ENCENDER LOS SERVOS</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>ARROWS GO THROUGH THE CHANGES, F2 ACCEPTS ALL OF THEM; ESC GOES BACK TO THE LIST</source>
      <translation>LAS FLECHAS RECORREN LOS CAMBIOS, F2 LOS ACEPTA TODOS; ESC VUELVE A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>F2 accepts; the drives stay off until then.</source>
      <translation>F2 acepta; hasta entonces los servos siguen apagados.</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>It is as it was accepted.</source>
      <translation>Está como fue aceptado.</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>MACHINE FILE</source>
      <translation>ARCHIVO DE MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>MACHINE FILE  ·  %1</source>
      <translation>ARCHIVO DE MÁQUINA  ·  %1</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>PRESS Y TO ACCEPT THE MACHINE FILE AS IT IS NOW, ESC TO LEAVE IT</source>
      <translation>OPRIMA Y PARA ACEPTAR EL ARCHIVO DE MÁQUINA COMO ESTÁ, ESC PARA DEJARLO</translation>
    </message>
    <message>
      <location filename="app/special/machine_file_acceptance.py" />
      <source>what has changed in it</source>
      <translation>lo que ha cambiado en él</translation>
    </message>
    <message>
      <location filename="app/special/part_count.py" />
      <source>TARGET REACHED: {count} OF {target} PARTS</source>
      <translation>META ALCANZADA: {count} DE {target} PIEZAS</translation>
    </message>
    <message>
      <location filename="app/special/part_count.py" />
      <source>THE LAST PART OF THE TARGET: CYCLE REPEAT IS SWITCHED OFF</source>
      <translation>LA ÚLTIMA PIEZA DE LA META: SE APAGÓ REPETIR CICLO</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>%1 is no number of parts; type a whole number from 0 to %2</source>
      <translation>%1 no es un número de piezas; escriba un entero de 0 a %2</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>CHOOSE A PROGRAM FIRST: EVERY PROGRAM HAS ITS OWN COUNT</source>
      <translation>ELIJA PRIMERO UN PROGRAMA: CADA PROGRAMA TIENE SU PROPIA CUENTA</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>In the cycle of the last part Cycle Repeat is switched off. 0 takes the target away.</source>
      <translation>En el ciclo de la última pieza se apaga la repetición de ciclo. 0 quita el objetivo.</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>NO COUNT: what runs is a dry run and no part. Nor is a restart that leaves something out.</source>
      <translation>SIN CONT: prueba en vacío, no una pieza. Tampoco lo es un rearranque que omite algo.</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>NO TARGET</source>
      <translation>SIN META</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>ONE LESS</source>
      <translation>MENOS 1</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>ONE MORE</source>
      <translation>MÁS 1</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>PARTS COUNTER</source>
      <translation>CONTADOR DE PIEZAS</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>PARTS MADE</source>
      <translation>PIEZAS HECHAS</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>PARTS TO GO</source>
      <translation>PIEZAS POR HACER</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>PRESS Y TO PUT THE COUNT TO NOUGHT, ESC TO KEEP IT</source>
      <translation>OPRIMA Y PARA PONER LA CUENTA EN CERO, ESC PARA CONSERVARLA</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>REFUSED: {made} PARTS ARE MADE ALREADY; F4 PUTS THE COUNT TO NOUGHT</source>
      <translation>RECHAZADO: YA SE HICIERON {made} PIEZAS; F4 PONE LA CUENTA EN CERO</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>STOP AT</source>
      <translation>PARAR EN</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>STOP AT HOW MANY PARTS?</source>
      <translation>¿PARAR EN CUÁNTAS PIEZAS?</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>THE COUNT IS AT NOUGHT</source>
      <translation>LA CUENTA ESTÁ EN CERO</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>TIME FOR THE PARTS TO GO</source>
      <translation>TIEMPO PARA LAS PIEZAS POR HACER</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>TYPE HOW MANY PARTS AND PRESS RETURN; ESC GOES BACK TO THE LIST</source>
      <translation>ESCRIBA CUÁNTAS PIEZAS Y OPRIMA RETURN; ESC REGRESA A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/special/parts_counter.py" />
      <source>parts made, stop at a number, times</source>
      <translation>piezas hechas, meta, tiempos</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>ARROWS MARK, RETURN GOES ON TO THE NEXT CHOICE; ESC GOES BACK TO THE LIST</source>
      <translation>LAS FLECHAS MARCAN, RETURN PASA A LA SIGUIENTE OPCIÓN; ESC REGRESA A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>COLOURS</source>
      <translation>COLORES</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>DARK</source>
      <translation>OSCURO</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>ENGLISH</source>
      <translation>ENGLISH</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>ESPAÑOL</source>
      <translation>ESPAÑOL</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>HIDDEN</source>
      <translation>OCULTA</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>LANGUAGE</source>
      <translation>IDIOMA</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>LARGE FIGURES SHOW</source>
      <translation>LAS CIFRAS GRANDES MUESTRAN</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>LIGHT</source>
      <translation>CLARO</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>OPERATOR STATION ON THE SCREEN</source>
      <translation>ESTACIÓN DEL OPERADOR EN LA PANTALLA</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>RELEASE THE E-STOP OF THE STATION BEFORE HIDING IT (U)</source>
      <translation>SUELTE EL PARO DE EMERGENCIA DE LA ESTACIÓN ANTES DE OCULTARLA (U)</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>SCREEN</source>
      <translation>PANTALLA</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>SHOWN</source>
      <translation>VISIBLE</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>THIS MACHINE HAS AN OPERATOR STATION OF ITS OWN: NONE IS SHOWN</source>
      <translation>ESTA MÁQUINA TIENE SU PROPIA ESTACIÓN DE OPERADOR: NO SE MUESTRA NINGUNA</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>The control is in %1 now.</source>
      <translation>El control está ahora en %1.</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>UNITS OF THE FIGURES</source>
      <translation>UNIDADES DE LAS CIFRAS</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>Units change the figures that are shown; what is typed is always in the control's unit.</source>
      <translation>Las unidades cambian las cifras que se muestran; lo que se escribe va en la unidad del control.</translation>
    </message>
    <message>
      <location filename="app/special/preferences.py" />
      <source>units, language, colours, station</source>
      <translation>unidades, idioma, colores, estación</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>%1 in</source>
      <translation>%1 pulg</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>%1 mm</source>
      <translation>%1 mm</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>CHUCK</source>
      <translation>PLATO</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>NOT SET</source>
      <translation>SIN AJUSTAR</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>TAILSTOCK</source>
      <translation>CONTRAPUNTO</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>X (radius) {x}   Z {z}   R {r}</source>
      <translation>X (radio) {x}   Z {z}   R {r}</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>bore {size}</source>
      <translation>agujero {size}</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>jaws {size}</source>
      <translation>garras {size}</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>not known</source>
      <translation>no se conoce</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>not known: the machine file says nothing under [clamping]</source>
      <translation>no se conoce: el archivo de la máquina no dice nada en [clamping]</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>{count} ERRORS: this program will not run as it stands</source>
      <translation>{count} ERRORES: este programa no puede ejecutarse así</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>{count} WARNINGS: look at them before the first part</source>
      <translation>{count} AVISOS: véalos antes de la primera pieza</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>{rpm} rpm at most</source>
      <translation>{rpm} rpm como máximo</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>{size} at least, as nobody has said it</source>
      <translation>{size} como mínimo, pues nadie lo ha dicho</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet.py" />
      <source>{tool} (assumed)</source>
      <translation>{tool} (supuesto)</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>A NOTE HAS {most} LETTERS AT MOST: TAKE ANOTHER ONE</source>
      <translation>UNA NOTA TIENE {most} LETRAS COMO MÁXIMO: TOME OTRA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>CHOOSE A PROGRAM FIRST: EVERY PROGRAM HAS ITS OWN SETUP SHEET</source>
      <translation>ELIJA PRIMERO UN PROGRAMA: CADA UNO TIENE SU HOJA DE PREPARACIÓN</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>F2 TAKES A NOTE, F6 WRITES THE SHEET AS PDF AND HTML; ESC GOES BACK TO THE LIST</source>
      <translation>F2 TOMA UNA NOTA, F6 ESCRIBE LA HOJA EN PDF Y HTML; ESC VUELVE A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>F2 TAKES A NOTE; RETURN CHANGES THE NOTE THAT IS MARKED</source>
      <translation>F2 TOMA UNA NOTA; RETURN CAMBIA LA NOTA MARCADA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>LETTER</source>
      <translation>CARTA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>MARK A NOTE FIRST</source>
      <translation>MARQUE PRIMERO UNA NOTA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>Making the sheet …</source>
      <translation>Se hace la hoja …</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>NO NOTE</source>
      <translation>SIN NOTA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>NOTE</source>
      <translation>NOTA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>PRESS Y TO THROW THIS NOTE AWAY, ESC TO KEEP IT</source>
      <translation>PULSE Y PARA BORRAR ESTA NOTA, ESC PARA CONSERVARLA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>RETURN WRITES THE SHEET TO THE MARKED PLACE; F4 LOOKS FOR STICKS AGAIN</source>
      <translation>RETURN ESCRIBE LA HOJA EN EL SITIO MARCADO; F4 BUSCA OTRA VEZ MEMORIAS USB</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>Return writes it there, as PDF and as HTML.</source>
      <translation>Return la escribe ahí, en PDF y en HTML.</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>SETUP SHEET</source>
      <translation>HOJA DE PREPARACIÓN</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>SETUP SHEET  ·  %1</source>
      <translation>HOJA DE PREPARACIÓN  ·  %1</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>SETUP SHEET  ·  WRITE TO WHERE?</source>
      <translation>HOJA DE PREPARACIÓN  ·  ¿DÓNDE SE ESCRIBE?</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>THE SHEET IS STILL BEING MADE: WAIT A MOMENT</source>
      <translation>LA HOJA AÚN SE ESTÁ HACIENDO: ESPERE UN MOMENTO</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>THERE ARE {most} NOTES ALREADY: CHANGE ONE OF THEM</source>
      <translation>YA HAY {most} NOTAS: CAMBIE UNA DE ELLAS</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>TYPE THE NOTE AND PRESS RETURN; ESC LEAVES IT AS IT WAS</source>
      <translation>ESCRIBA LA NOTA Y PULSE RETURN; ESC LA DEJA COMO ESTABA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>WRITE</source>
      <translation>ESCRIBIR</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>Writing …</source>
      <translation>Se escribe …</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>tools, stock, stops, notes; on paper</source>
      <translation>herramientas, material, notas; en papel</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_function.py" />
      <source>{name} IS WHOLE AND ON THE DISK: A STICK MAY BE REMOVED</source>
      <translation>{name} ESTÁ ENTERO Y EN EL DISCO: PUEDE RETIRAR LA MEMORIA USB</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>NOTES</source>
      <translation>NOTAS</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>None.</source>
      <translation>Ninguna.</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>OFFSET</source>
      <translation>CORRECTOR</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>SECONDARY AND ZERO OFFSETS</source>
      <translation>CORRECTORES SECUNDARIOS Y DE CERO</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>STATION</source>
      <translation>PUESTO</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>Section: stock light, finished part dark</source>
      <translation>Sección: material claro, pieza acabada oscura</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>TIME A PART</source>
      <translation>TIEMPO POR PIEZA</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>WHAT THE OPERATOR READS</source>
      <translation>LO QUE LEE EL OPERADOR</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>X (radius)</source>
      <translation>X (radio)</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>no T</source>
      <translation>sin T</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_page.py" />
      <source>what live tools mill is not in it</source>
      <translation>lo que fresan las herramientas motorizadas no está</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_work.py" />
      <source>ERRORS</source>
      <translation>ERRORES</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_work.py" />
      <source>Setup sheet: {program}</source>
      <translation>Hoja de preparación: {program}</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_work.py" />
      <source>TEXT (SHA-256)</source>
      <translation>TEXTO (SHA-256)</translation>
    </message>
    <message>
      <location filename="app/special/setup_sheet_work.py" />
      <source>WARNINGS</source>
      <translation>AVISOS</translation>
    </message>
    <message>
      <location filename="app/special/special_functions.py" />
      <source>ARROWS OR A FIGURE CHOOSE A FUNCTION, RETURN OPENS IT; ESC FOR AUTOMATIC</source>
      <translation>FLECHAS O UNA CIFRA ELIGEN UNA FUNCIÓN, RETURN LA ABRE; ESC A AUTOMÁTICO</translation>
    </message>
    <message>
      <location filename="app/special/special_functions.py" />
      <source>ESC GOES BACK TO THE LIST</source>
      <translation>ESC REGRESA A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>%1 rpm is not between %2 and %3 rpm, which this spindle can turn</source>
      <translation>%1 rpm no está entre %2 y %3 rpm, que es lo que gira este husillo</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>COMMANDED NOW</source>
      <translation>ORDENADA AHORA</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>It acts at once, also while a program runs.</source>
      <translation>Actúa de inmediato, también con un programa en marcha.</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>LIMIT IN FORCE</source>
      <translation>TOPE VIGENTE</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>MACHINE'S OWN MAXIMUM</source>
      <translation>MÁXIMO PROPIO DE LA MÁQUINA</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>MAXIMUM SPINDLE SPEED</source>
      <translation>VELOCIDAD MÁXIMA DEL HUSILLO</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>MAXIMUM SPINDLE SPEED?</source>
      <translation>¿VELOCIDAD MÁXIMA DEL HUSILLO?</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>MEASURED NOW</source>
      <translation>MEDIDA AHORA</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>NO LIMIT</source>
      <translation>SIN TOPE</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>NO LIMIT IS IN FORCE</source>
      <translation>NO HAY TOPE VIGENTE</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>PRESS Y TO LIFT THE LIMIT, ESC TO KEEP IT</source>
      <translation>OPRIMA Y PARA QUITAR EL TOPE, ESC PARA CONSERVARLO</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>Programs that ask for more turn at the limit.</source>
      <translation>Los programas que piden más giran al tope.</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>SPINDLE LIMITED TO {rpm} RPM UNTIL RESTART</source>
      <translation>HUSILLO LIMITADO A {rpm} RPM HASTA REINICIAR</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>TYPE A SPEED AND PRESS RETURN; IT TAKES ARITHMETIC; ESC GOES BACK TO THE LIST</source>
      <translation>ESCRIBA UNA VELOCIDAD Y OPRIMA RETURN; ACEPTA OPERACIONES; ESC REGRESA A LA LISTA</translation>
    </message>
    <message>
      <location filename="app/special/spindle_limit.py" />
      <source>a limit until restart</source>
      <translation>un tope hasta reiniciar</translation>
    </message>
    <message>
      <location filename="app/transfer/line_transfer.py" />
      <source>RECEIVED</source>
      <translation>RECIBIDO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>BITS, PARITY, STOP BITS</source>
      <translation>BITS, PARIDAD, BITS DE PARADA</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>CR LF</source>
      <translation>CR LF</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>DC CODES</source>
      <translation>CÓDIGOS DC</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>FLOW CONTROL</source>
      <translation>CONTROL DE FLUJO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>FRAME</source>
      <translation>MARCO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>LEADER OF NULS</source>
      <translation>CABECERA DE NULOS</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>LINE END</source>
      <translation>FIN DE LÍNEA</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>PORT</source>
      <translation>PUERTO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_settings.py" />
      <source>WAIT FOR DC1 TO SEND</source>
      <translation>ESPERAR DC1 PARA ENVIAR</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>7 BITS, EVEN PARITY, FOUND OUT</source>
      <translation>7 BITS, PARIDAD PAR, DETECTADO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>A PROGRAM IS UNDER WAY: RETURN STORES IT AS IT IS NAMED; ANOTHER NAME CAN BE TYPED AT REST</source>
      <translation>HAY UN PROGRAMA EN CURSO: RETURN LO GUARDA CON ESE NOMBRE; OTRO SE ESCRIBE EN REPOSO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>A TRANSFER IS UNDER WAY: WAIT UNTIL IT IS DONE, OR F6 GIVES IT UP</source>
      <translation>HAY UNA TRANSFERENCIA EN CURSO: ESPERE A QUE TERMINE, O F6 LA ABANDONA</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>A WHOLE PROGRAM HAS COME: {lines} LINES</source>
      <translation>HA LLEGADO UN PROGRAMA COMPLETO: {lines} LÍNEAS</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>ARROWS MARK A SETTING, RETURN CHANGES IT; F4 SENDS THE PROGRAM ON THE DESK, F5 RECEIVES ONE</source>
      <translation>LAS FLECHAS MARCAN UN AJUSTE, RETURN LO CAMBIA; F4 ENVÍA EL PROGRAMA CARGADO, F5 RECIBE UNO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>AS SET</source>
      <translation>COMO SE AJUSTÓ</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>BYTES</source>
      <translation>BYTES</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>CALLS ITSELF</source>
      <translation>SE LLAMA</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>CANCEL</source>
      <translation>CANCELAR</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>CHARACTERS</source>
      <translation>CARACTERES</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>DISCARD</source>
      <translation>DESECHAR</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>DONE</source>
      <translation>HECHO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>F4 sends: {program}</source>
      <translation>F4 envía: {program}</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>F6 GIVES THE TRANSFER UP; IT GOES ON WHILE OTHER PAGES ARE SHOWN</source>
      <translation>F6 ABANDONA LA TRANSFERENCIA; CONTINÚA MIENTRAS SE VEN OTRAS PÁGINAS</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>FOR DC1 FROM THE OTHER SIDE</source>
      <translation>DC1 DEL OTRO LADO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>FOR THE FIRST %</source>
      <translation>EL PRIMER %</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>FOR THE OTHER SIDE TO SEND</source>
      <translation>QUE EL OTRO LADO ENVÍE</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>HEARS</source>
      <translation>OYE</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>HELD BY THE OTHER SIDE (XOFF)</source>
      <translation>DETENIDA POR EL OTRO LADO (XOFF)</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>It replaces nothing and starts nothing.</source>
      <translation>No reemplaza ni arranca nada.</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>LINES</source>
      <translation>LÍNEAS</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>NAME OF THE NEW PROGRAM?</source>
      <translation>¿NOMBRE DEL PROGRAMA NUEVO?</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>NO ERROR</source>
      <translation>SIN ERRORES</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>NO PORT IS SET: RETURN ON THE FIRST LINE CHOOSES ONE</source>
      <translation>NO HAY PUERTO: RETURN EN LA PRIMERA LÍNEA ELIGE UNO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>NO PROGRAM IS ON THE DESK: CHOOSE THE ONE TO SEND FIRST (F2)</source>
      <translation>NO HAY PROGRAMA CARGADO: ELIJA ANTES EL QUE SE ENVÍA (F2)</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>NOTHING IS KEPT: {why}</source>
      <translation>NO SE GUARDA NADA: {why}</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>PORTS</source>
      <translation>PUERTOS</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>PRESS Y TO THROW THE RECEIVED PROGRAM AWAY, ESC TO KEEP IT</source>
      <translation>OPRIMA Y PARA DESECHAR EL PROGRAMA RECIBIDO, ESC PARA CONSERVARLO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>RECEIVE</source>
      <translation>RECIBIR</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>RECEIVING</source>
      <translation>RECIBIENDO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>RETURN STORES IT AS A NEW PROGRAM AND STARTS NOTHING; F6 THROWS IT AWAY</source>
      <translation>RETURN LO GUARDA COMO PROGRAMA NUEVO Y NO ARRANCA NADA; F6 LO DESECHA</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>SEND</source>
      <translation>ENVIAR</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>SENDING</source>
      <translation>ENVIANDO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>SETTING</source>
      <translation>AJUSTE</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>SHA-256</source>
      <translation>SHA-256</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>SKIPPED BEFORE IT</source>
      <translation>OMITIDOS ANTES</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>STORED AS A NEW PROGRAM: {name}. NOTHING WAS STARTED</source>
      <translation>GUARDADO COMO PROGRAMA NUEVO: {name}. NO SE HA ARRANCADO NADA</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>THE RECEIVED PROGRAM IS THROWN AWAY</source>
      <translation>EL PROGRAMA RECIBIDO SE HA DESECHADO</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>VALUE</source>
      <translation>VALOR</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>WAITS</source>
      <translation>ESPERA</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>WHAT COMES IS NO TEXT: LOOK AT BAUD, BITS AND PARITY</source>
      <translation>LO QUE LLEGA NO ES TEXTO: REVISE BAUDIOS, BITS Y PARIDAD</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>programs over the serial line</source>
      <translation>programas por la línea serie</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>{count} ERRORS</source>
      <translation>{count} ERRORES</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>{count} LINES</source>
      <translation>{count} LÍNEAS</translation>
    </message>
    <message>
      <location filename="app/transfer/serial_transfer.py" />
      <source>{name} IS SENT: {count} BYTES</source>
      <translation>{name} ENVIADO: {count} BYTES</translation>
    </message>
    <message>
      <location filename="app/working_plane/plane_drawing.py" />
      <source>FRONT</source>
      <translation>FRENTE</translation>
    </message>
    <message>
      <location filename="app/working_plane/plane_drawing.py" />
      <source>RIGHT</source>
      <translation>DERECHA</translation>
    </message>
    <message>
      <location filename="app/working_plane/working_plane_view.py" />
      <source>TABLE AND PLANE</source>
      <translation>MESA Y PLANO</translation>
    </message>
    <message>
      <location filename="core/alarms/__init__.py" />
      <source>Bus, feeder and controller</source>
      <translation>Bus, alimentador y controlador</translation>
    </message>
    <message>
      <location filename="core/alarms/__init__.py" />
      <source>Operator station and stops</source>
      <translation>Estación del operador y paros</translation>
    </message>
    <message>
      <location filename="core/alarms/__init__.py" />
      <source>Slides and axis drives</source>
      <translation>Carros y servos</translation>
    </message>
    <message>
      <location filename="core/alarms/__init__.py" />
      <source>Spindle, C axis and threads</source>
      <translation>Husillo, eje C y roscas</translation>
    </message>
    <message>
      <location filename="core/alarms/__init__.py" />
      <source>The control</source>
      <translation>El control</translation>
    </message>
    <message>
      <location filename="core/alarms/alarm_entry.py" />
      <source>the slides brake and hold, spindle off, outputs safe; Reset acknowledges</source>
      <translation>los carros frenan y se sostienen, husillo apagado, salidas seguras; Reset reconoce</translation>
    </message>
    <message>
      <location filename="core/alarms/alarm_entry.py" />
      <source>the slides brake and lose power, spindle off, outputs safe; Reset acknowledges</source>
      <translation>los carros frenan y pierden potencia, husillo apagado, salidas seguras; Reset reconoce</translation>
    </message>
    <message>
      <location filename="core/alarms/alarm_entry.py" />
      <source>the slides stop on the path, the spindle goes on turning; Cycle Start goes on</source>
      <translation>los carros paran sobre la trayectoria, el husillo sigue girando; inicio de ciclo continúa</translation>
    </message>
    <message>
      <location filename="core/alarms/alarm_entry.py" />
      <source>what was asked for: a stop that somebody pressed or programmed</source>
      <translation>lo que se pidió: un paro que alguien oprimió o programó</translation>
    </message>
    <message>
      <location filename="core/alarms/alarms_page.py" />
      <source>Likely: %1.  </source>
      <translation>Probable: %1.  </translation>
    </message>
    <message>
      <location filename="core/alarms/alarms_page.py" />
      <source>alarm, drives off</source>
      <translation>alarma, servos apagados</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>E-stop is pressed or the safety circuit is open</source>
      <translation>el paro de emergencia está oprimido o el circuito de seguridad está abierto</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>Reset, Drives On, home all axes before anything is started</source>
      <translation>Reset, encienda servos, referencie todos los ejes antes de arrancar nada</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>Reset, Drives On, home; if it stands on the switch move it off by hand first</source>
      <translation>Reset, encienda servos, referencie; si está sobre el interruptor, sáquelo antes a mano</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>Reset, Drives On, start again; if it comes again, the log says what was refused</source>
      <translation>Reset, encienda servos, arranque otra vez; si se repite, la bitácora dice qué se rechazó</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>Reset, Drives On; compare the machine file with the drives before the program is run again</source>
      <translation>Reset, encienda servos; compare el archivo de máquina con los servos antes de correr otra vez el programa</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>Reset, Drives On; end other programs on this computer, and restart at the line</source>
      <translation>Reset, encienda servos; cierre otros programas de esta computadora y reinicie en la línea</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a drive does not take its settings</source>
      <translation>un servo no acepta sus ajustes</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a drive has restarted</source>
      <translation>un servo se reinició</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a drive has tripped: its display says why</source>
      <translation>un servo se disparó: su pantalla dice por qué</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a drive keeps its fault</source>
      <translation>un servo conserva su falla</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a drive shows a fault</source>
      <translation>un servo muestra una falla</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a drive was not ready any more</source>
      <translation>un servo ya no estaba listo</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a fuse or the drives' supply</source>
      <translation>un fusible o la alimentación de los servos</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a motor or encoder cable</source>
      <translation>un cable de motor o de encoder</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a move beyond what the drives allow</source>
      <translation>un movimiento más allá de lo que permiten los servos</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a node number is wrong</source>
      <translation>un número de nodo está mal</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>a slide has hit its limit switch</source>
      <translation>un carro tocó su interruptor de límite</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>an axis drive does not answer</source>
      <translation>el servo de un eje no responde</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>an axis has moved unasked</source>
      <translation>un eje se movió sin que nadie lo pidiera</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>an axis is not where it ought to stand</source>
      <translation>un eje no está donde debe estar</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>axis drive fault</source>
      <translation>falla de servo de eje</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>axis sent, its encoder does not count</source>
      <translation>un eje recibe orden y su encoder no cuenta</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>bus cable or power</source>
      <translation>cable del bus o alimentación</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>check its supply, Reset, Drives On; home again</source>
      <translation>revise su alimentación, Reset, encienda servos; referencia otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>check the drive's power and bus cable, Reset, Drives On; home again</source>
      <translation>revise alimentación y cable de bus del servo, Reset, encienda servos; referencia otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>close the safety circuit, Reset, Drives On; home where the axis asks for it</source>
      <translation>cierre el circuito de seguridad, Reset, encienda servos; referencia donde el eje la pida</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>homing has failed</source>
      <translation>la búsqueda de referencia falló</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>it has failed</source>
      <translation>se averió</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>it has to be switched off and on</source>
      <translation>hay que apagarlo y encenderlo</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>it is another drive than the machine file says, or has other firmware</source>
      <translation>es otro servo que el del archivo de máquina, o tiene otro firmware</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>it sinks: no brake, or the brake slips</source>
      <translation>se cae: sin freno, o el freno patina</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>it was moved before it was homed</source>
      <translation>se movió antes de referenciarse</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>it was moved by hand while the drives are off</source>
      <translation>se movió a mano con los servos apagados</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>its bus cable is off or damaged</source>
      <translation>su cable de bus está suelto o dañado</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>its control power broke down for a moment</source>
      <translation>su alimentación de control falló por un momento</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>its encoder or the encoder's cable</source>
      <translation>su encoder o el cable del encoder</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>its limit was hit</source>
      <translation>se tocó su límite</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>its power is off</source>
      <translation>no tiene alimentación</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>keep clear of the slide, it may jump when it comes free; look what holds it, Reset, Drives On</source>
      <translation>aléjese del carro, puede saltar al soltarse; vea qué lo detiene, Reset, encienda servos</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>look at switch and direction, Reset, Drives On, home again</source>
      <translation>revise interruptor y dirección, Reset, encienda servos, referencia otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>look for what keeps the slide from its place, Reset</source>
      <translation>busque qué impide al carro llegar a su lugar, Reset</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>look where the slide really stands; check encoder and coupling, Reset, Drives On, home the axis</source>
      <translation>vea dónde está el carro de verdad; revise encoder y cople, Reset, encienda servos, referencia del eje</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>look where the slide stands and that nothing is in its way, Reset, Drives On</source>
      <translation>vea dónde está el carro y que nada le estorbe, Reset, encienda servos</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>look where the tool stands, free the slide, Reset, Drives On; home where the axis asks for it</source>
      <translation>vea dónde está la herramienta, libere el carro, Reset, encienda servos; referencia donde el eje la pida</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>read the drive's display, put the cause right, Reset, Drives On</source>
      <translation>lea la pantalla del servo, corrija la causa, Reset, encienda servos</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>read the drive's display; switch the machine off and on when it does not clear</source>
      <translation>lea la pantalla del servo; apague y encienda la máquina si no se borra</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>release the E-stop, switch the drives' power on, Reset, Drives On</source>
      <translation>suelte el paro de emergencia, encienda la alimentación de los servos, Reset, encienda servos</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>run 'turndesk machine check' with the machine file: it names the setting</source>
      <translation>corra 'turndesk machine check' con el archivo de máquina: nombra el ajuste</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>slide does not arrive</source>
      <translation>el carro no llega</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>somebody else moves the drive: its own software, a pendant</source>
      <translation>otro mueve el servo: su propio software, un mando</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>somebody has reset it or works on it by its own software</source>
      <translation>alguien lo reinició o trabaja en él con su propio software</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>something was asked of the drives that they cannot do now</source>
      <translation>se pidió a los servos algo que ahora no pueden hacer</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>speed or travel in the machine file differ from the drives' own</source>
      <translation>velocidad o recorrido del archivo de máquina difieren de los del servo</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the bus was disturbed</source>
      <translation>el bus tuvo interferencias</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the cause still stands: too hot, no motor, no encoder</source>
      <translation>la causa sigue: demasiado caliente, sin motor, sin encoder</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the computer was busy with something else for too long</source>
      <translation>la computadora estuvo ocupada con otra cosa demasiado tiempo</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the controller was stopped while the slides moved</source>
      <translation>el controlador se detuvo mientras los carros se movían</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the cut is too heavy</source>
      <translation>el corte es demasiado pesado</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the drive has no power or its motor cable is off</source>
      <translation>el servo no tiene potencia o su cable de motor está suelto</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the drive holds it too softly, or its motor cable is off</source>
      <translation>el servo lo sostiene muy débil, o su cable de motor está suelto</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the drives do not come on</source>
      <translation>los servos no encienden</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the drives have lost power</source>
      <translation>los servos perdieron la potencia</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the drives ran out of setpoints</source>
      <translation>los servos se quedaron sin consignas</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the drives refuse</source>
      <translation>los servos rechazan</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the drives' main power is off</source>
      <translation>la potencia de los servos está apagada</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the encoder, its cable or its coupling: the slide may have moved all the same</source>
      <translation>el encoder, su cable o su cople: el carro pudo moverse de todos modos</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the motor cable is off</source>
      <translation>el cable del motor está suelto</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the position is lost</source>
      <translation>se perdió la posición</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the safety circuit has opened: door, guard, E-stop elsewhere on the machine</source>
      <translation>el circuito de seguridad se abrió: puerta, guarda, otro paro de emergencia de la máquina</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the slide is blocked</source>
      <translation>el carro está bloqueado</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the slide is blocked or runs stiff</source>
      <translation>el carro está bloqueado o corre duro</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the slide is blocked, or the tool has run into something</source>
      <translation>el carro está bloqueado, o la herramienta chocó con algo</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the slide is jammed, or something pushes against it</source>
      <translation>el carro está atorado, o algo lo empuja</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the slide is jammed, or the tool has run into something</source>
      <translation>el carro está atorado, o la herramienta chocó con algo</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the spindle was too fast for the thread's lead</source>
      <translation>el husillo iba demasiado rápido para el paso de la rosca</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the switch or its cable</source>
      <translation>el interruptor o su cable</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the switch was not found: its cable, or the slide went the wrong way</source>
      <translation>no se encontró el interruptor: su cable, o el carro fue al lado equivocado</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the travel in the machine file is too long</source>
      <translation>el recorrido en el archivo de máquina es demasiado largo</translation>
    </message>
    <message>
      <location filename="core/alarms/axis_alarms.py" />
      <source>the window for in position is too narrow in the machine file</source>
      <translation>la ventana de posición en el archivo de máquina es demasiado angosta</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>E-stop at the controller</source>
      <translation>paro de emergencia en el controlador</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>PRESS E-STOP, the spindle may turn; check cable and power, Reset connects again. Home where asked</source>
      <translation>PULSE PARO DE EMERGENCIA, el husillo puede girar; revise cable y corriente, Reset conecta de nuevo. Referencie donde se pida</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>PRESS E-STOP, the spindle may turn; check cable, terminators, interface; Reset opens the bus again</source>
      <translation>PULSE PARO DE EMERGENCIA, el husillo puede girar; revise cable, terminadores e interfaz; Reset abre el bus de nuevo</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>PRESS E-STOP, the spindle may turn; look at the tool; Reset starts another. Home where asked</source>
      <translation>PULSE PARO DE EMERGENCIA, el husillo puede girar; mire la herramienta; Reset inicia otro. Referencie donde se pida</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>PRESS E-STOP, the spindle may turn; look where the tool stands; Reset ends it and starts another</source>
      <translation>PULSE PARO DE EMERGENCIA, el husillo puede girar; mire dónde está la herramienta; Reset lo termina e inicia otro</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>Reset, Drives On; compare its settings with the machine file ('turndesk machine check')</source>
      <translation>Reset, encienda servos; compare sus ajustes con el archivo de máquina ('turndesk machine check')</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>a line was damaged on its way</source>
      <translation>una línea se dañó en el camino</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>alarm of the controller</source>
      <translation>alarma del controlador</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>an I/O module does not answer</source>
      <translation>un módulo de E/S no responde</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>an output cannot be switched</source>
      <translation>una salida no se puede conmutar</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>another master is on the bus</source>
      <translation>hay otro maestro en el bus</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>another program has written to the controller</source>
      <translation>otro programa escribió al controlador</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>check the cable, Reset; switch the controller off and on when it does not answer</source>
      <translation>revise el cable, Reset; apague y encienda el controlador si no responde</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>check the module's power and cable, Reset, Drives On; look what the outputs have let go</source>
      <translation>revise alimentación y cable del módulo, Reset, encienda servos; vea qué soltaron las salidas</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>check the output in the machine file, Reset</source>
      <translation>revise la salida en el archivo de máquina, Reset</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>end whatever else talks to the controller, Reset, Drives On</source>
      <translation>cierre lo demás que hable con el controlador, Reset, encienda servos</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>it has restarted: its outputs have fallen</source>
      <translation>se reinició: sus salidas cayeron</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>it was reset unseen</source>
      <translation>se reinició sin que se viera</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>its E-stop or reset input is on</source>
      <translation>su entrada de paro de emergencia o de reset está activa</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>its bus cable or power</source>
      <translation>su cable de bus o alimentación</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>its cable, or its line is disturbed</source>
      <translation>su cable, o su línea tiene interferencias</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>its module has failed</source>
      <translation>su módulo se averió</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>its reset button or input</source>
      <translation>su botón o entrada de reset</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>its settings forbid what the program asks for: travel, speed, spindle</source>
      <translation>sus ajustes prohíben lo que pide el programa: recorrido, velocidad, husillo</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>its supply broke down for a moment</source>
      <translation>su alimentación falló por un momento</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>put right what is named, Reset, Drives On; home where asked</source>
      <translation>corrija lo que se nombra, Reset, encienda servos; referencia donde se pida</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>release the E-stop, Reset, Drives On</source>
      <translation>suelte el paro de emergencia, Reset, encienda servos</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>spindle and coolant are off: close the door, Reset, Drives On</source>
      <translation>husillo y refrigerante están apagados: cierre la puerta, Reset, encienda servos</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the CAN cable is off, or a terminator is missing</source>
      <translation>el cable CAN está suelto, o falta un terminador</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the CAN interface was unplugged</source>
      <translation>se desconectó la interfaz CAN</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the cable to the controller was pulled or damaged</source>
      <translation>el cable al controlador se jaló o se dañó</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the computer is overloaded: the slides stop at the end of what they have</source>
      <translation>la computadora está sobrecargada: los carros paran al final de lo que tienen</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the computer ran out of memory</source>
      <translation>la computadora se quedó sin memoria</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the connection to the controller is lost</source>
      <translation>se perdió la conexión con el controlador</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the controller does not answer</source>
      <translation>el controlador no responde</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the controller hangs</source>
      <translation>el controlador se trabó</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the controller has lost its modes</source>
      <translation>el controlador perdió sus modos</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the controller refuses a block</source>
      <translation>el controlador rechaza un bloque</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the controller was reset</source>
      <translation>el controlador se reinició</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the controller's power is off</source>
      <translation>el controlador no tiene alimentación</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the door was opened in the cycle</source>
      <translation>la puerta se abrió en el ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the door's switch or cable</source>
      <translation>el interruptor de la puerta o su cable</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the drive bus has failed</source>
      <translation>falló el bus de los servos</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the feeder does not answer</source>
      <translation>el alimentador no responde</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the feeder has ended</source>
      <translation>el alimentador terminó</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the feeder has failed</source>
      <translation>el alimentador se averió</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the feeder process was ended or has failed: slides, spindle and outputs are off</source>
      <translation>el proceso alimentador se terminó o falló: carros, husillo y salidas están apagados</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the machine file does not name it, or the controller does not have it</source>
      <translation>el archivo de máquina no la nombra, o el controlador no la tiene</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the program is given up: look where the tool stands, Reset, Drives On, home</source>
      <translation>el programa se abandonó: vea dónde está la herramienta, Reset, encienda servos, referencia</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>the safety door is open</source>
      <translation>la puerta de seguridad está abierta</translation>
    </message>
    <message>
      <location filename="core/alarms/bus_alarms.py" />
      <source>what the controller's number says</source>
      <translation>lo que dice el número del controlador</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>PRESS E-STOP, switch the machine off; save the log (F10), end TurnDesk and start it again</source>
      <translation>OPRIMA EL PARO DE EMERGENCIA, apague la máquina; guarde la bitácora (F10), cierre TurnDesk y ábralo otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>PRESS E-STOP: what is shown is not of now; save the log, end TurnDesk and start it again</source>
      <translation>OPRIMA EL PARO DE EMERGENCIA: lo que se ve no es de ahora; guarde la bitácora, cierre TurnDesk y ábralo otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>Reset, Drives On; save program and log (F10), and restart at another line</source>
      <translation>Reset, encienda servos; guarde programa y bitácora (F10) y reinicie en otra línea</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>a driver does not come back: its wire, its adapter, the computer's disk or network</source>
      <translation>un controlador de equipo no regresa: su cable, su adaptador, el disco o la red de la computadora</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>a driver does not do what a stop asks of it: a wire is off, or it has failed</source>
      <translation>un controlador de equipo no hace lo que pide un paro: un cable suelto, o se averió</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>a fuse, a relay or a terminal has switched it</source>
      <translation>un fusible, un relevador o una terminal la conmutó</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>a mistake in TurnDesk; nothing of the wrong piece was moved</source>
      <translation>un error de TurnDesk; nada del tramo malo se movió</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>a mistake in TurnDesk; the log has it</source>
      <translation>un error de TurnDesk; está en la bitácora</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>an input or a counter led to a line that was never run before</source>
      <translation>una entrada o un contador llevó a una línea que nunca se había corrido</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>an output is not as commanded</source>
      <translation>una salida no está como se ordenó</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>another program, a backup or an update keeps this computer busy</source>
      <translation>otro programa, un respaldo o una actualización ocupa esta computadora</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>check the tool's offset and where the slides stood at the start; Reset</source>
      <translation>revise la compensación de la herramienta y dónde estaban los carros al arrancar; Reset</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>compare the end of the program with the original, add M30, load it again</source>
      <translation>compare el final del programa con el original, agregue M30, cárguelo otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>correct the line in the editor (F3), load the program again</source>
      <translation>corrija la línea en el editor (F3), cargue el programa otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>end of travel</source>
      <translation>fin de carrera</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>look at the tool; read what starts again, then Cycle Start; measure the part: it is not counted</source>
      <translation>vea la herramienta; lea qué arranca otra vez y luego inicio de ciclo; mida la pieza: no se cuenta</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>look where the tool stands; save the log (F10), end TurnDesk and start it again</source>
      <translation>vea dónde está la herramienta; guarde la bitácora (F10), cierre TurnDesk y ábralo otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>look why; read what is switched again, then Cycle Start; measure the part, it is not counted</source>
      <translation>busque por qué; lea qué se conmuta otra vez y luego inicio de ciclo; mida la pieza, no se cuenta</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>program error</source>
      <translation>error de programa</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>setpoints ran low</source>
      <translation>se agotaron las consignas</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>somebody else switches it: a pendant, the drive's own software</source>
      <translation>otro la conmuta: un mando, el propio software del servo</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the computer is too slow or too hot, or its disk hangs</source>
      <translation>la computadora es muy lenta o está muy caliente, o su disco se traba</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the computer was too late</source>
      <translation>la computadora llegó tarde</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the control has failed</source>
      <translation>el control falló</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the control's thread is stuck or dead</source>
      <translation>el hilo del control está atorado o muerto</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the feeder has switched off</source>
      <translation>el alimentador apagó</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the last line is missing: cut off when it was sent or copied</source>
      <translation>falta la última línea: se cortó al enviarlo o copiarlo</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the machine could not be made safe</source>
      <translation>no se pudo poner la máquina en estado seguro</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the offset of the tool, or the zero of the part, is wrong</source>
      <translation>la compensación de la herramienta o el cero de la pieza está mal</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the planned path does not fit together</source>
      <translation>la trayectoria planeada no empalma</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the program ends without M30 or M02</source>
      <translation>el programa termina sin M30 ni M02</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the program was started at another place than it was proved from</source>
      <translation>el programa arrancó en otro lugar que donde se probó</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the screen was locked or the computer asleep</source>
      <translation>la pantalla estaba bloqueada o la computadora dormida</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>the slides have stopped on the path; end other programs, then Cycle Start</source>
      <translation>los carros pararon sobre la trayectoria; cierre otros programas y luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/control_alarms.py" />
      <source>this line cannot be run as it stands</source>
      <translation>esta línea no se puede correr como está</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>C moves while the spindle turns</source>
      <translation>C se mueve mientras gira el husillo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>E-stop is pressed</source>
      <translation>el paro de emergencia está oprimido</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>IF THE SPINDLE TURNS PRESS E-STOP; then check the inverter's cable and power, Reset</source>
      <translation>SI EL HUSILLO GIRA OPRIMA EL PARO DE EMERGENCIA; luego revise cable y alimentación del variador, Reset</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>PRESS E-STOP; look at belt and encoder before the spindle is started again</source>
      <translation>OPRIMA EL PARO DE EMERGENCIA; revise banda y encoder antes de arrancar otra vez el husillo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>PRESS E-STOP; then find out why before it is started again</source>
      <translation>OPRIMA EL PARO DE EMERGENCIA; luego busque por qué antes de arrancarlo otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>Reset, Drives On; try M19 in MDI</source>
      <translation>Reset, encienda servos; pruebe M19 en MDI</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>WAIT UNTIL THE SPINDLE STANDS; check air, collet and bar, Reset</source>
      <translation>ESPERE A QUE EL HUSILLO PARE; revise aire, boquilla y barra, Reset</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>X was drawn back: look at part and insert; the thread is not finished</source>
      <translation>X se retiró: vea pieza e inserto; la rosca no está terminada</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>a fault of its drive stands</source>
      <translation>hay una falla de su variador</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>a thread needs a turning spindle</source>
      <translation>una rosca necesita un husillo que gire</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>air was lost while the spindle turned</source>
      <translation>se perdió el aire mientras el husillo giraba</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>bar or part keeps it from moving</source>
      <translation>la barra o la pieza no la deja moverse</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>baud rate or address</source>
      <translation>velocidad en baudios o dirección</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>check air and switch, Reset</source>
      <translation>revise el aire y el interruptor, Reset</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>check encoder and cable, Reset; without it no thread is cut</source>
      <translation>revise encoder y cable, Reset; sin él no se corta ninguna rosca</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>close the collet with M12, Reset, start again</source>
      <translation>cierre la boquilla con M12, Reset, arranque otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>collet does not answer</source>
      <translation>la boquilla no responde</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>collet has opened</source>
      <translation>la boquilla se abrió</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>counts a turn in the machine file</source>
      <translation>cuentas por vuelta en el archivo de máquina</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>encoder and spindle drive disagree</source>
      <translation>encoder y variador del husillo no coinciden</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>feed per revolution with a still spindle</source>
      <translation>avance por vuelta con el husillo parado</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>it has restarted or reports a fault</source>
      <translation>se reinició o reporta una falla</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>it is held as C</source>
      <translation>está sostenido como C</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>it was started at the drive itself</source>
      <translation>se arrancó en el propio variador</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>it was stopped from outside</source>
      <translation>se paró desde fuera</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>its cable</source>
      <translation>su cable</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>its cable is off, or disturbed by the motor cable</source>
      <translation>su cable está suelto, o el cable del motor lo perturba</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>its index was not found</source>
      <translation>no se encontró su índice</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>its pot was turned down</source>
      <translation>se bajó su perilla</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>its power</source>
      <translation>su alimentación</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>its supply or motor cable</source>
      <translation>su alimentación o el cable del motor</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>its switch or cable</source>
      <translation>su interruptor o cable</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>let it come to speed, then Cycle Start</source>
      <translation>deje que tome velocidad y luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>look at spindle and tool; Cycle Start starts it again, as it says, and goes on</source>
      <translation>vea husillo y herramienta; inicio de ciclo lo arranca otra vez, como se anuncia, y continúa</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>look at spindle and tool; Cycle Start tries again, Reset gives the program up</source>
      <translation>vea husillo y herramienta; inicio de ciclo lo intenta otra vez, Reset abandona el programa</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>look at the spindle, Reset; try the speed in MDI before the program is run again</source>
      <translation>vea el husillo, Reset; pruebe la velocidad en MDI antes de correr otra vez el programa</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>no M03 or M04 before the cut</source>
      <translation>no hay M03 ni M04 antes del corte</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>no M03 or M04 before the thread</source>
      <translation>no hay M03 ni M04 antes de la rosca</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>no air</source>
      <translation>no hay aire</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>on this machine the spindle is C, and M05 is missing before this line</source>
      <translation>en esta máquina el husillo es C, y falta M05 antes de esta línea</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>power was lost meanwhile</source>
      <translation>mientras tanto se perdió la potencia</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>put M05 before M13, load the program again</source>
      <translation>ponga M05 antes de M13, cargue el programa otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>put M05 before the line, load the program again</source>
      <translation>ponga M05 antes de la línea, cargue el programa otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>put right what is named, Reset, start again</source>
      <translation>corrija lo que se nombra, Reset, arranque otra vez</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>read the drive's display, put the cause right, Reset</source>
      <translation>lea la pantalla del variador, corrija la causa, Reset</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>something between control and spindle has switched it off: safety circuit, guard, its drive</source>
      <translation>algo entre control y husillo lo apagó: circuito de seguridad, guarda, su variador</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle below half its speed</source>
      <translation>husillo por debajo de la mitad de su velocidad</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle drive fault</source>
      <translation>falla del variador del husillo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle encoder lost</source>
      <translation>se perdió el encoder del husillo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle has stopped</source>
      <translation>el husillo se detuvo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle ignores the command</source>
      <translation>el husillo no obedece la orden</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle lost in a thread</source>
      <translation>husillo perdido en una rosca</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle not at its speed</source>
      <translation>el husillo no está en su velocidad</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle not at speed</source>
      <translation>el husillo no llega a su velocidad</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle override at 0</source>
      <translation>perilla del husillo en 0</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle start with the collet open</source>
      <translation>arranque del husillo con la boquilla abierta</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle stopped</source>
      <translation>husillo parado</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>spindle switch off</source>
      <translation>interruptor del husillo en OFF</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>start the spindle before the thread; without an encoder use a die or tap</source>
      <translation>arranque el husillo antes de la rosca; sin encoder use tarraja o machuelo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>start the spindle in the program before this line</source>
      <translation>arranque el husillo en el programa antes de esta línea</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>start the spindle, then Cycle Start; else Reset</source>
      <translation>arranque el husillo y luego inicio de ciclo; si no, Reset</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>switch it to AUTO, let the spindle come to speed, then Cycle Start</source>
      <translation>póngalo en AUTO, deje que el husillo tome velocidad y luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the belt slips</source>
      <translation>la banda patina</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the belt slips or is off</source>
      <translation>la banda patina o se salió</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the collet's switch does not answer</source>
      <translation>el interruptor de la boquilla no responde</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the cut stalled the spindle</source>
      <translation>el corte frenó el husillo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the drive did not change over in time</source>
      <translation>el variador no conmutó a tiempo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the encoder's coupling is loose</source>
      <translation>el cople del encoder está flojo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the feeder had no word of the control for a moment and made the machine safe</source>
      <translation>el alimentador no supo del control por un momento y puso la máquina segura</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the inverter does not answer</source>
      <translation>el variador no responde</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the program starts the spindle before M12</source>
      <translation>el programa arranca el husillo antes de M12</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the speed is more than it reaches with this chuck and part</source>
      <translation>la velocidad es más de la que alcanza con este mandril y pieza</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle did not come back to its speed: load, belt, drive</source>
      <translation>el husillo no volvió a su velocidad: carga, banda, variador</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle does not become C</source>
      <translation>el husillo no pasa a ser C</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle does not turn: belt, brake, or its drive is not enabled</source>
      <translation>el husillo no gira: banda, freno, o su variador no está habilitado</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle drive does not follow its command: cable, settings, local mode at its keypad</source>
      <translation>el variador del husillo no sigue su orden: cable, ajustes, modo local en su teclado</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle drive has tripped: its display says why</source>
      <translation>el variador del husillo se disparó: su pantalla dice por qué</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle may not start</source>
      <translation>el husillo no puede arrancar</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle pot stands at 0</source>
      <translation>la perilla del husillo está en 0</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle pot was turned down</source>
      <translation>se bajó la perilla del husillo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle still turns where the program opens the collet</source>
      <translation>el husillo todavía gira donde el programa abre la boquilla</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle switch stands at OFF</source>
      <translation>el interruptor del husillo está en OFF</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle was stopped while the program fed by the revolution</source>
      <translation>el husillo se paró mientras el programa avanzaba por vuelta</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>the spindle was switched off during the pass</source>
      <translation>el husillo se apagó durante la pasada</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>this machine has no encoder on the spindle</source>
      <translation>esta máquina no tiene encoder en el husillo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>too heavy a cut</source>
      <translation>un corte demasiado pesado</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>turn the spindle pot up, let it come to speed, then Cycle Start</source>
      <translation>suba la perilla del husillo, deje que tome velocidad y luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/spindle_alarms.py" />
      <source>unclamping refused</source>
      <translation>apertura de boquilla rechazada</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>Cycle Start goes on; O switches Optional Stop off</source>
      <translation>inicio de ciclo continúa; O apaga el paro opcional</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>Cycle Start goes on; Reset gives the program up</source>
      <translation>inicio de ciclo continúa; Reset abandona el programa</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>Cycle Start runs the next block; S switches Single Block off</source>
      <translation>inicio de ciclo corre el bloque siguiente; S apaga bloque a bloque</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>M00 in the program</source>
      <translation>M00 en el programa</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>M01 in the program, and Optional Stop is on</source>
      <translation>M01 en el programa, y el paro opcional está activo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>Reset was pressed: the program was given up</source>
      <translation>se oprimió Reset: el programa se abandonó</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>Single Block is on: each block waits for Cycle Start</source>
      <translation>bloque a bloque está activo: cada bloque espera el inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>an E-stop button was pressed</source>
      <translation>se oprimió un botón de paro de emergencia</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>check cable and power of the station; its buttons do nothing now. Then Cycle Start</source>
      <translation>revise cable y alimentación de la estación; sus botones ahora no hacen nada. Luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>close the guard; Cycle Start says what it starts again</source>
      <translation>cierre la guarda; Inicio de ciclo dice qué vuelve a arrancar</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>do what the message says, then Cycle Start</source>
      <translation>haga lo que dice el mensaje y luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>feed hold</source>
      <translation>retención de avance</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>feed hold was pressed</source>
      <translation>se oprimió la retención de avance</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>guard open</source>
      <translation>guarda abierta</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>held by the control</source>
      <translation>retenido por el control</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>its cable is loose</source>
      <translation>su cable está flojo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>its cable or its hub</source>
      <translation>su cable o su concentrador</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>its own feed hold or safety door input is on</source>
      <translation>su propia entrada de retención o de puerta de seguridad está activa</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>look at the controller's hold and door inputs, then Cycle Start</source>
      <translation>revise las entradas de retención y puerta del controlador y luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>look where the tool stands before anything is started</source>
      <translation>vea dónde está la herramienta antes de arrancar nada</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>make the machine safe, release the button, then Drives On</source>
      <translation>ponga la máquina segura, suelte el botón y luego encienda servos</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>nothing: it was asked for</source>
      <translation>nada: se pidió</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>operator station silent</source>
      <translation>estación del operador en silencio</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>optional stop</source>
      <translation>paro opcional</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>override pot jumps</source>
      <translation>la perilla salta</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>pendant lost</source>
      <translation>colgante perdido</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>plug it in again, then Cycle Start. Who works without it takes [pendant] and what is at it out of the machine file</source>
      <translation>enchúfelo de nuevo, luego Cycle Start. Quien trabaje sin él quita [pendant] y lo que cuelga de él del archivo de máquina</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>program stop</source>
      <translation>paro de programa</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>put right what is named, then Cycle Start</source>
      <translation>corrija lo que se nombra y luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>single block</source>
      <translation>bloque a bloque</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>stopped by hand</source>
      <translation>parado a mano</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>the controller holds</source>
      <translation>el controlador retiene</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>the feed or spindle pot has a worn track</source>
      <translation>la perilla de avance o de husillo tiene la pista gastada</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>the guard was opened in the cycle</source>
      <translation>la guarda se abrió en el ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>the guard's switch or cable</source>
      <translation>el interruptor de la guarda o su cable</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>the pendant was unplugged</source>
      <translation>se desenchufó el colgante</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>the safety circuit has opened</source>
      <translation>el circuito de seguridad se abrió</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>the spindle was stopped by hand</source>
      <translation>el husillo se paró a mano</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>the station's cable is off or damaged</source>
      <translation>el cable de la estación está suelto o dañado</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>turn the pot slowly through its range; if it still jumps change it. Then Cycle Start</source>
      <translation>gire despacio la perilla por todo su rango; si aún salta cámbiela. Luego inicio de ciclo</translation>
    </message>
    <message>
      <location filename="core/alarms/station_alarms.py" />
      <source>what is told here</source>
      <translation>lo que se dice aquí</translation>
    </message>
    <message>
      <location filename="core/executor/changed_offsets.py" />
      <source>another program is under way: new offsets are taken by the same program only</source>
      <translation>hay otro programa en marcha: las compensaciones nuevas sólo las toma el mismo programa</translation>
    </message>
    <message>
      <location filename="core/executor/changed_offsets.py" />
      <source>the changed offsets are in force</source>
      <translation>las compensaciones cambiadas están en vigor</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>%1 %2 by hand</source>
      <translation>%1 %2 a mano</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>%1: outputs are switched by hand only at rest, not in state %2</source>
      <translation>%1: las salidas sólo se cambian a mano en reposo, no en el estado %2</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>a program is under way: it keeps the offsets that it was proved with</source>
      <translation>hay un programa en curso: conserva las compensaciones con que se comprobó</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>a program is under way: it must end or be reset before another is loaded</source>
      <translation>hay un programa en curso: debe terminar o abandonarse antes de cargar otro</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>a program is under way: its spindle is stopped by feed hold and reset</source>
      <translation>hay un programa en curso: su husillo se para con retención de avance y reset</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>a start at the first line is meant</source>
      <translation>se quiere arrancar en la primera línea</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>an alarm stands: press Reset first</source>
      <translation>hay una alarma: oprima primero Reset</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>drive test: %1</source>
      <translation>prueba de accionamiento: %1</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>drive test: its lease is over before anything could move</source>
      <translation>prueba de accionamiento: su plazo acabó antes de que nada pudiera moverse</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>drives cannot be switched on in state %1</source>
      <translation>los servos no se pueden encender en el estado %1</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>feed override %1 is not between 0 and 1.5</source>
      <translation>la perilla de avance %1 no está entre 0 y 1.5</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>homing: %1</source>
      <translation>referencia: %1</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>it was let go</source>
      <translation>se soltó</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>its button is up</source>
      <translation>su botón está suelto</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>jog: %1</source>
      <translation>mover a mano: %1</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>no jog in state %1</source>
      <translation>no se mueve a mano en el estado %1</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>no other part: %1</source>
      <translation>ninguna otra pieza: %1</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>parts may go on</source>
      <translation>las piezas pueden seguir</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>press both palm buttons</source>
      <translation>oprima los dos botones de palma</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>something else was asked for</source>
      <translation>se pidió otra cosa</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>spindle limit %1 is not between 0 and %2 rpm</source>
      <translation>el tope del husillo %1 no está entre 0 y %2 rpm</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>spindle limit %1 rpm</source>
      <translation>tope del husillo %1 rpm</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>state %1</source>
      <translation>estado %1</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>the collet is not opened by hand while the spindle turns</source>
      <translation>la boquilla no se abre a mano mientras gira el husillo</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>the machine has not yet said what it does: wait a moment, then switch the drives on</source>
      <translation>la máquina aún no ha dicho qué hace: espere un momento y conecte los accionamientos</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>the offsets of the tables are in force</source>
      <translation>las compensaciones de las tablas están vigentes</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>the spindle limit is raised only while the spindle stands</source>
      <translation>el tope del husillo sólo se sube con el husillo parado</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>there is no switch %1</source>
      <translation>no hay interruptor %1</translation>
    </message>
    <message>
      <location filename="core/executor/command_handler.py" />
      <source>this machine has no output %1</source>
      <translation>esta máquina no tiene la salida %1</translation>
    </message>
    <message>
      <location filename="core/executor/commanded_outputs.py" />
      <source>%1 HAS COME ON</source>
      <translation>SE ENCENDIÓ %1</translation>
    </message>
    <message>
      <location filename="core/executor/commanded_outputs.py" />
      <source>%1 HAS GONE OFF</source>
      <translation>SE APAGÓ %1</translation>
    </message>
    <message>
      <location filename="core/executor/controller_motion.py" />
      <source>line %1 has no feed</source>
      <translation>la línea %1 no tiene avance</translation>
    </message>
    <message>
      <location filename="core/executor/controller_motion.py" />
      <source>this controller moves X and Z only</source>
      <translation>este controlador mueve sólo X y Z</translation>
    </message>
    <message>
      <location filename="core/executor/cycle.py" />
      <source>FEED OVERRIDE AT 0</source>
      <translation>AVANCE EN 0 POR LA PERILLA</translation>
    </message>
    <message>
      <location filename="core/executor/cycle.py" />
      <source>SPINDLE BELOW HALF ITS SPEED</source>
      <translation>HUSILLO A MENOS DE LA MITAD DE SU VELOCIDAD</translation>
    </message>
    <message>
      <location filename="core/executor/cycle.py" />
      <source>THE CONTROLLER HOLDS</source>
      <translation>EL CONTROLADOR RETIENE</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>%1 is a rotary axis; drive tests are for slides</source>
      <translation>%1 es un eje rotativo; las pruebas de accionamiento son para carros</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>%1 is not homed: nobody knows whether the test has room</source>
      <translation>%1 no está referenciado: nadie sabe si la prueba tiene sitio</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>%1 is still moving</source>
      <translation>%1 todavía se mueve</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>%1 needs %2 mm in %3 for it, and its travel ends before</source>
      <translation>%1 necesita %2 mm en %3 para ello, y su recorrido acaba antes</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>a drive test needs a lease above 0</source>
      <translation>una prueba de accionamiento necesita un plazo mayor que 0</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>feed hold is pressed</source>
      <translation>la retención de avance está oprimida</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>its controller plans by itself and takes no setpoints: no test can be played to its drives</source>
      <translation>su controlador planifica por sí mismo y no toma consignas: no se puede hacer ninguna prueba con sus accionamientos</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>the guard is open</source>
      <translation>la protección está abierta</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test.py" />
      <source>the spindle turns; stop it first</source>
      <translation>el husillo gira; párelo antes</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test_path.py" />
      <source>%1 mm are too short to become even at %2 mm/s</source>
      <translation>%1 mm son demasiado cortos para hacerse uniformes a %2 mm/s</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test_path.py" />
      <source>a ramp is faster than 0 and no faster than %1 mm/s, as the hand moves it</source>
      <translation>una rampa es más rápida que 0 y no más que %1 mm/s, como la mueve la mano</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test_path.py" />
      <source>a sine has from 0.5 to 200 Hz</source>
      <translation>un seno tiene de 0,5 a 200 Hz</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test_path.py" />
      <source>a test of this shape is larger than 0 and no larger than %1 mm</source>
      <translation>una prueba de esta forma es mayor que 0 y no mayor que %1 mm</translation>
    </message>
    <message>
      <location filename="core/executor/drive_test_path.py" />
      <source>this driver tells %1 samples a second: too few for a sine of %2 Hz</source>
      <translation>este controlador da %1 muestras por segundo: demasiado pocas para un seno de %2 Hz</translation>
    </message>
    <message>
      <location filename="core/executor/executor.py" />
      <source>%1 came too late to be obeyed</source>
      <translation>%1 llegó demasiado tarde para obedecerse</translation>
    </message>
    <message>
      <location filename="core/executor/executor.py" />
      <source>GUARD OPEN</source>
      <translation>GUARDA ABIERTA</translation>
    </message>
    <message>
      <location filename="core/executor/executor.py" />
      <source>feed %1 %</source>
      <translation>avance %1 %</translation>
    </message>
    <message>
      <location filename="core/executor/executor.py" />
      <source>the button at the station</source>
      <translation>el botón de la estación</translation>
    </message>
    <message>
      <location filename="core/executor/executor.py" />
      <source>the control was away for %1 s</source>
      <translation>el control estuvo ausente %1 s</translation>
    </message>
    <message>
      <location filename="core/executor/executor.py" />
      <source>the pendant is there again</source>
      <translation>el colgante está de nuevo</translation>
    </message>
    <message>
      <location filename="core/executor/feed_hold.py" />
      <source>SPINDLE NOT AT ITS SPEED</source>
      <translation>EL HUSILLO NO ESTÁ A SU VELOCIDAD</translation>
    </message>
    <message>
      <location filename="core/executor/following_error.py" />
      <source>%1 degrees</source>
      <translation>%1 grados</translation>
    </message>
    <message>
      <location filename="core/executor/following_error.py" />
      <source>%1 has moved by %2</source>
      <translation>%1 se movió %2</translation>
    </message>
    <message>
      <location filename="core/executor/following_error.py" />
      <source>%1 is %2 off its setpoint</source>
      <translation>%1 está a %2 de su consigna</translation>
    </message>
    <message>
      <location filename="core/executor/following_error.py" />
      <source>%1 stays %2 off its setpoint</source>
      <translation>%1 queda a %2 de su consigna</translation>
    </message>
    <message>
      <location filename="core/executor/following_error.py" />
      <source>%1 was sent %2, its encoder stands</source>
      <translation>%1 recibió %2, su encoder no se mueve</translation>
    </message>
    <message>
      <location filename="core/executor/geared_thread_pass.py" />
      <source>the thread could not be queued in time</source>
      <translation>la rosca no se pudo encolar a tiempo</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>a click is longer than 0 and no longer than %1, not %2</source>
      <translation>un clic es mayor que 0 y no mayor que %1, no %2</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>a key or finger came while it was turned</source>
      <translation>se oprimió una tecla o la pantalla mientras giraba</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>handwheel: %1</source>
      <translation>volante: %1</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>it moves nothing in state %1</source>
      <translation>no mueve nada en el estado %1</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>it needs a lease above 0</source>
      <translation>necesita un plazo mayor que 0</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>it was turned while a key or finger was held</source>
      <translation>se giró mientras se mantenía una tecla o un dedo</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>its counts leap: check its cable</source>
      <translation>su cuenta salta: revise el cable</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>its enabling switch is not held</source>
      <translation>no se sostiene su botón de habilitación</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>key and handwheel at once move nothing</source>
      <translation>tecla y volante a la vez no mueven nada</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>the page that asked for it was silent</source>
      <translation>la página que lo pedía calló</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>the station's switch does not select %1</source>
      <translation>el interruptor de la estación no elige %1</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>this machine has none</source>
      <translation>esta máquina no tiene ninguno</translation>
    </message>
    <message>
      <location filename="core/executor/handwheel.py" />
      <source>turned faster than %1 goes; clicks are dropped</source>
      <translation>gira más deprisa de lo que va %1; se pierden clics</translation>
    </message>
    <message>
      <location filename="core/executor/homing_order.py" />
      <source>every axis knows its position</source>
      <translation>todos los ejes conocen su posición</translation>
    </message>
    <message>
      <location filename="core/executor/homing_order.py" />
      <source>this machine has no axis %1 to home</source>
      <translation>esta máquina no tiene eje %1 que referenciar</translation>
    </message>
    <message>
      <location filename="core/executor/interrupted_job.py" />
      <source>%1 line %2, T%3, part %4: %5</source>
      <translation>%1 línea %2, T%3, pieza %4: %5</translation>
    </message>
    <message>
      <location filename="core/executor/interrupted_job.py" />
      <source>GIVEN UP BY RESET</source>
      <translation>ABANDONADO POR RESET</translation>
    </message>
    <message>
      <location filename="core/executor/interrupted_job.py" />
      <source>THE CONTROL LOST ITS POWER OR WAS KILLED</source>
      <translation>EL CONTROL PERDIÓ LA CORRIENTE O FUE TERMINADO A LA FUERZA</translation>
    </message>
    <message>
      <location filename="core/executor/interrupted_job.py" />
      <source>THE CONTROL WAS CLOSED</source>
      <translation>EL CONTROL SE CERRÓ</translation>
    </message>
    <message>
      <location filename="core/executor/interruption_watch.py" />
      <source>%1; %2 was loaded in its place</source>
      <translation>%1; se cargó %2 en su lugar</translation>
    </message>
    <message>
      <location filename="core/executor/interruption_watch.py" />
      <source>%1; the program begins anew</source>
      <translation>%1; el programa empieza de nuevo</translation>
    </message>
    <message>
      <location filename="core/executor/interruption_watch.py" />
      <source>go on there by SEARCHTO (F6), or press Y</source>
      <translation>siga allí con BUSCAR A (F6), u oprima la tecla Y</translation>
    </message>
    <message>
      <location filename="core/executor/interruption_watch.py" />
      <source>jog it clear, press Y</source>
      <translation>sáquela a mano, oprima la tecla Y</translation>
    </message>
    <message>
      <location filename="core/executor/interruption_watch.py" />
      <source>line %1 of %2 was interrupted and T%3 may stand in the part: %4 and then start at the first line</source>
      <translation>la línea %1 de %2 se interrumpió y T%3 puede estar en la pieza: %4 y luego arranque en la primera línea</translation>
    </message>
    <message>
      <location filename="core/executor/interruption_watch.py" />
      <source>there is no interrupted job to be answered for now</source>
      <translation>ahora no hay trabajo interrumpido por el que responder</translation>
    </message>
    <message>
      <location filename="core/executor/job.py" />
      <source>the control counts in %1 now</source>
      <translation>el control cuenta ahora en %1</translation>
    </message>
    <message>
      <location filename="core/executor/job.py" />
      <source>the rapid rate is another one now</source>
      <translation>la velocidad de rápido es otra ahora</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>%1 drive test</source>
      <translation>prueba de accionamiento de %1</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>%1 is at the end of its travel in %2</source>
      <translation>%1 está al fin de su carrera en %2</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>%1 is still being jogged</source>
      <translation>%1 todavía se mueve a mano</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>%1 is still in its drive test</source>
      <translation>%1 todavía está en su prueba de accionamiento</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>%1 is still moving; wait for the end of its step</source>
      <translation>%1 todavía se mueve; espere el final de su paso</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>%1 is still on its step</source>
      <translation>%1 todavía está en su paso</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>%1 was stopped before the end of its drive test</source>
      <translation>%1 se paró antes del final de su prueba de accionamiento</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>%1 was stopped before the end of its step</source>
      <translation>%1 se detuvo antes del final de su paso</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>C is the spindle, and the spindle turns; stop it first</source>
      <translation>C es el husillo, y el husillo gira; párelo primero</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>a jog needs a velocity and a lease above 0</source>
      <translation>mover a mano necesita velocidad y un plazo mayores que 0</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>a step is longer than 0 and no longer than %1, not %2</source>
      <translation>un paso es mayor que 0 y no más de %1, no %2</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>a step needs a speed above 0</source>
      <translation>un paso necesita velocidad mayor que 0</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>the controller is still moving</source>
      <translation>el controlador todavía se mueve</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>the spindle's drive becomes C: let go, and begin again in two seconds</source>
      <translation>el variador del husillo pasa a ser C: suelte y empiece de nuevo en dos segundos</translation>
    </message>
    <message>
      <location filename="core/executor/jogging.py" />
      <source>this machine has no axis %1 to jog</source>
      <translation>esta máquina no tiene eje %1 que mover a mano</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>%1 was given up</source>
      <translation>%1 se abandonó</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>FORWARD</source>
      <translation>ADELANTE</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>REVERSE</source>
      <translation>EN REVERSA</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>SWITCH TO AUTO: %1</source>
      <translation>INTERRUPTOR EN AUTO: %1</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>THE SPINDLE STARTS AT %1 RPM %2</source>
      <translation>EL HUSILLO ARRANCA A %1 RPM %2</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>WARNING: %1</source>
      <translation>AVISO: %1</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>a driver does not obey: %1</source>
      <translation>un controlador de equipo no obedece: %1</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>reset: wait until the slides are at rest</source>
      <translation>reset: espere a que los carros estén en reposo</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>setpoints ran low; the slides stop on the path</source>
      <translation>las consignas se agotaban; los carros paran sobre la trayectoria</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>that was meant just now: let both palms go, read the prompt, press them again</source>
      <translation>eso se ha contestado ahora mismo: suelte los dos pulsadores, lea el aviso y vuelva a pulsarlos</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>the tool setter is touched: jog away from it</source>
      <translation>el palpador de herramientas está tocado: aléjese de él</translation>
    </message>
    <message>
      <location filename="core/executor/machine_control.py" />
      <source>while giving the program up: %1</source>
      <translation>al abandonar el programa: %1</translation>
    </message>
    <message>
      <location filename="core/executor/parts_made.py" />
      <source>NO COUNT is on</source>
      <translation>SIN CONT está puesto</translation>
    </message>
    <message>
      <location filename="core/executor/parts_made.py" />
      <source>a restart left something of it out</source>
      <translation>un rearranque omitió algo de ella</translation>
    </message>
    <message>
      <location filename="core/executor/parts_made.py" />
      <source>its cycle was disturbed (%1): measure it, and add it on F10 if it is good</source>
      <translation>su ciclo fue perturbado (%1): mídala, y súmela en F10 si es buena</translation>
    </message>
    <message>
      <location filename="core/executor/parts_made.py" />
      <source>part %1, %2 s</source>
      <translation>pieza %1, %2 s</translation>
    </message>
    <message>
      <location filename="core/executor/path_section.py" />
      <source>at rest because something outside the control holds it</source>
      <translation>en reposo porque algo fuera del control lo retiene</translation>
    </message>
    <message>
      <location filename="core/executor/path_section.py" />
      <source>at rest because the override is 0</source>
      <translation>en reposo porque la perilla está en 0</translation>
    </message>
    <message>
      <location filename="core/executor/path_section.py" />
      <source>at rest where single block wants it</source>
      <translation>en reposo donde lo pide bloque a bloque</translation>
    </message>
    <message>
      <location filename="core/executor/path_section.py" />
      <source>it moves</source>
      <translation>se mueve</translation>
    </message>
    <message>
      <location filename="core/executor/path_section.py" />
      <source>there is none, or it has come to its end</source>
      <translation>no hay ninguno, o llegó a su final</translation>
    </message>
    <message>
      <location filename="core/executor/program_run.py" />
      <source>%1, and the program says nothing of it</source>
      <translation>%1, y el programa no dice nada de ello</translation>
    </message>
    <message>
      <location filename="core/executor/program_run.py" />
      <source>PROOF WITH THE CHANGED OFFSETS</source>
      <translation>COMPROBACIÓN CON LAS COMPENSACIONES CAMBIADAS</translation>
    </message>
    <message>
      <location filename="core/executor/program_run.py" />
      <source>from line %1</source>
      <translation>desde la línea %1</translation>
    </message>
    <message>
      <location filename="core/executor/program_run.py" />
      <source>no repeat: %1</source>
      <translation>sin repetición: %1</translation>
    </message>
    <message>
      <location filename="core/executor/program_run.py" />
      <source>program end</source>
      <translation>fin de programa</translation>
    </message>
    <message>
      <location filename="core/executor/program_run.py" />
      <source>program given up by reset</source>
      <translation>programa abandonado con reset</translation>
    </message>
    <message>
      <location filename="core/executor/program_run.py" />
      <source>the line was given up by reset</source>
      <translation>la línea se abandonó con reset</translation>
    </message>
    <message>
      <location filename="core/executor/raised_alarm.py" />
      <source> line %1</source>
      <translation> línea %1</translation>
    </message>
    <message>
      <location filename="core/executor/raised_alarm.py" />
      <source>asked for by %1</source>
      <translation>pedido por %1</translation>
    </message>
    <message>
      <location filename="core/executor/read_ahead.py" />
      <source>line %1 feeds by the revolution</source>
      <translation>la línea %1 avanza por vuelta</translation>
    </message>
    <message>
      <location filename="core/executor/read_ahead.py" />
      <source>line %1 moves %2 to %3 %4 from home</source>
      <translation>la línea %1 lleva %2 a %3 %4 de la referencia</translation>
    </message>
    <message>
      <location filename="core/executor/read_ahead.py" />
      <source>line %1 moves C while the spindle turns</source>
      <translation>la línea %1 mueve C mientras gira el husillo</translation>
    </message>
    <message>
      <location filename="core/executor/recorder.py" />
      <source>%1: old records cannot be removed: %2</source>
      <translation>%1: los registros antiguos no se pueden quitar: %2</translation>
    </message>
    <message>
      <location filename="core/executor/recorder.py" />
      <source>alarm line</source>
      <translation>línea de la alarma</translation>
    </message>
    <message>
      <location filename="core/executor/recorder.py" />
      <source>the record is kept in memory alone: %1</source>
      <translation>el registro se guarda solo en memoria: %1</translation>
    </message>
    <message>
      <location filename="core/executor/recorder.py" />
      <source>the record of an alarm is lost: %1</source>
      <translation>se ha perdido el registro de una alarma: %1</translation>
    </message>
    <message>
      <location filename="core/executor/recorder.py" />
      <source>the record of this alarm is being written: look again in two seconds</source>
      <translation>el registro de esta alarma se está escribiendo: mire de nuevo en dos segundos</translation>
    </message>
    <message>
      <location filename="core/executor/recorder.py" />
      <source>the record of this alarm is no longer kept; the newest %1 are</source>
      <translation>el registro de esta alarma ya no se conserva; se conservan los %1 más recientes</translation>
    </message>
    <message>
      <location filename="core/executor/safe_stop.py" />
      <source>the outputs</source>
      <translation>las salidas</translation>
    </message>
    <message>
      <location filename="core/executor/safe_stop.py" />
      <source>the slides</source>
      <translation>los carros</translation>
    </message>
    <message>
      <location filename="core/executor/safe_stop.py" />
      <source>while stopping %1: %2</source>
      <translation>al parar %1: %2</translation>
    </message>
    <message>
      <location filename="core/executor/setpoint_motion.py" />
      <source>the spindle changed its speed faster than the slides could follow: check the thread</source>
      <translation>el husillo cambió de velocidad más rápido de lo que los carros podían seguir: revise la rosca</translation>
    </message>
    <message>
      <location filename="core/executor/snapshot.py" />
      <source>DRIVES OFF</source>
      <translation>SERVOS APAGADOS</translation>
    </message>
    <message>
      <location filename="core/executor/snapshot.py" />
      <source>RUNNING</source>
      <translation>EN MARCHA</translation>
    </message>
    <message>
      <location filename="core/executor/snapshot.py" />
      <source>STOPPING</source>
      <translation>DETENIENDO</translation>
    </message>
    <message>
      <location filename="core/executor/snapshot.py" />
      <source>WAITING</source>
      <translation>ESPERANDO</translation>
    </message>
    <message>
      <location filename="core/executor/snapshot.py" />
      <source>back off</source>
      <translation>retroceda</translation>
    </message>
    <message>
      <location filename="core/executor/snapshot.py" />
      <source>state %1 cannot become %2</source>
      <translation>el estado %1 no puede pasar a %2</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>SPINDLE HAS STOPPED</source>
      <translation>EL HUSILLO SE DETUVO</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>SPINDLE OVERRIDE AT 0</source>
      <translation>PERILLA DEL HUSILLO EN 0</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>SPINDLE STOPPED</source>
      <translation>HUSILLO PARADO</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>SPINDLE SWITCH OFF</source>
      <translation>INTERRUPTOR DEL HUSILLO APAGADO</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>it turns at %1 rpm, %2 are commanded</source>
      <translation>gira a %1 rpm, se ordenaron %2</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>the encoder on the spindle counts nothing</source>
      <translation>el encoder del husillo no cuenta nada</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>the spindle</source>
      <translation>el husillo</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>the spindle does not turn</source>
      <translation>el husillo no gira</translation>
    </message>
    <message>
      <location filename="core/executor/spindle_control.py" />
      <source>the spindle's drive tells a speed that is no number</source>
      <translation>el variador del husillo da una velocidad que no es un número</translation>
    </message>
    <message>
      <location filename="core/executor/standstill.py" />
      <source>AT SPEED</source>
      <translation>A SU VELOCIDAD</translation>
    </message>
    <message>
      <location filename="core/executor/standstill.py" />
      <source>DWELL</source>
      <translation>ESPERA</translation>
    </message>
    <message>
      <location filename="core/executor/standstill.py" />
      <source>SPINDLE STOP</source>
      <translation>PARO DE HUSILLO</translation>
    </message>
    <message>
      <location filename="core/executor/standstill.py" />
      <source>cycle repeat off by M31</source>
      <translation>repetir ciclo apagado por M31</translation>
    </message>
    <message>
      <location filename="core/executor/standstill.py" />
      <source>the spindle turns at %1 rpm</source>
      <translation>el husillo gira a %1 rpm</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>%1 must be homed first</source>
      <translation>%1 necesita primero su referencia</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>%1, and the program says nothing of it: load it again</source>
      <translation>%1, y el programa no dice nada de eso: cárguelo de nuevo</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>E-stop is pressed: release it</source>
      <translation>el paro de emergencia está oprimido: suéltelo</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>an alarm stands: clear its cause and press Reset</source>
      <translation>hay una alarma: elimine su causa y oprima Reset</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>ask for the way out again</source>
      <translation>pida otra vez la salida</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>line %1: a thread needs an encoder on the spindle, and there is none</source>
      <translation>línea %1: una rosca necesita un encoder en el husillo, y no lo hay</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>line %1: this controller cannot do %2</source>
      <translation>línea %1: este controlador no puede hacer %2</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>look first: %1; then start again</source>
      <translation>vea primero: %1; luego arranque otra vez</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>no line is ready: type one and press Enter</source>
      <translation>no hay línea lista: escriba una y oprima Enter</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>no program is loaded</source>
      <translation>no hay programa cargado</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>no restart is ready: search a line and confirm it</source>
      <translation>no hay rearranque listo: busque una línea y confírmela</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>press Enter again</source>
      <translation>oprima Enter otra vez</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>search for the line again</source>
      <translation>busque la línea otra vez</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the collet is %1 and must be %2 at line %3: use MDI</source>
      <translation>la boquilla está %1 y debe estar %2 en la línea %3: use MDI</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the drives are off: switch them on</source>
      <translation>los servos están apagados: enciéndalos</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the guard is open: close it</source>
      <translation>la guarda está abierta: ciérrela</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the machine is being jogged</source>
      <translation>la máquina se mueve a mano</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the machine is homing</source>
      <translation>la máquina busca su referencia</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the program has errors: %1</source>
      <translation>el programa tiene errores: %1</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the program is not proved yet</source>
      <translation>el programa aún no está comprobado</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the program was loaded anew: search for the line again</source>
      <translation>el programa se cargó de nuevo: busque la línea otra vez</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the proof belongs to another program or to other offsets: load it again</source>
      <translation>la comprobación es de otro programa o de otras compensaciones: cárguelo de nuevo</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the slides have moved since this was proved: %1</source>
      <translation>los carros se movieron desde la comprobación: %1</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the spindle is not started with the collet open: close it first</source>
      <translation>el husillo no arranca con la boquilla abierta: ciérrela primero</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the start inhibit switch is on</source>
      <translation>el interruptor que impide el arranque está puesto</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>the state has changed since the line was proved: %1</source>
      <translation>el estado cambió desde que se comprobó la línea: %1</translation>
    </message>
    <message>
      <location filename="core/executor/start_conditions.py" />
      <source>tool offset %1 has never been set</source>
      <translation>la compensación de herramienta %1 nunca se puso</translation>
    </message>
    <message>
      <location filename="core/executor/station_signals.py" />
      <source>OPERATOR STATION SILENT</source>
      <translation>LA ESTACIÓN DEL OPERADOR NO RESPONDE</translation>
    </message>
    <message>
      <location filename="core/executor/station_signals.py" />
      <source>OVERRIDE POT JUMPS</source>
      <translation>LA PERILLA SALTA</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>%1 BY ITSELF</source>
      <translation>%1 POR SÍ SOLO</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>%1 FOR %2 S, %3: %4</source>
      <translation>%1 DURANTE %2 S, %3: %4</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>%1: its drive tells a position that is no number</source>
      <translation>%1: su servo da una posición que no es un número</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>COMES ON</source>
      <translation>SE ENCIENDE</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>CONTROL WAS SILENT</source>
      <translation>EL CONTROL CALLABA</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>FOUND ON, SWITCHED OFF</source>
      <translation>ENCONTRADO CONECTADO, DESCONECTADO</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>GOES OFF</source>
      <translation>SE APAGA</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>SWITCHED OFF</source>
      <translation>DESCONECTADO</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>THE FEEDER HAS SWITCHED OFF</source>
      <translation>EL ALIMENTADOR APAGÓ</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>THE MACHINE WAS NOT HEARD</source>
      <translation>NO SE OÍA A LA MÁQUINA</translation>
    </message>
    <message>
      <location filename="core/executor/supervision.py" />
      <source>output %1</source>
      <translation>la salida %1</translation>
    </message>
    <message>
      <location filename="core/executor/thread_path.py" />
      <source>%1 in the pull-out: the thread is cut, its end runs out short</source>
      <translation>%1 en la salida: la rosca está cortada, su final sale corto</translation>
    </message>
    <message>
      <location filename="core/executor/thread_path.py" />
      <source>%1: the tool left the thread at Z%2, behind it this pass is not cut</source>
      <translation>%1: la herramienta salió de la rosca en Z%2, más allá esta pasada no se cortó</translation>
    </message>
    <message>
      <location filename="core/executor/thread_path.py" />
      <source>a thread has no length or no lead</source>
      <translation>una rosca no tiene largo o no tiene paso</translation>
    </message>
    <message>
      <location filename="core/executor/thread_path.py" />
      <source>the spindle fell to %1 of %2 rpm</source>
      <translation>el husillo cayó a %1 de %2 rpm</translation>
    </message>
    <message>
      <location filename="core/executor/thread_path.py" />
      <source>the spindle turned the wrong way, at %1 rpm</source>
      <translation>el husillo giró al revés, a %1 rpm</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>%1 is not homed: its position means nothing</source>
      <translation>%1 no está referenciado: su posición no dice nada</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>a tool is not touched off along %1</source>
      <translation>una herramienta no se toca a lo largo de %1</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>another direction was asked for</source>
      <translation>se pidió otra dirección</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>it ran %1 past the touch, more than overtravel: look at the setter</source>
      <translation>pasó %1 del toque, más que overtravel: mire el palpador</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>its button %1 is up</source>
      <translation>su botón %1 está suelto</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>its search would leave the travel of %1 by %2: jog back</source>
      <translation>su búsqueda saldría del recorrido de %1 en %2: retroceda</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>no axis</source>
      <translation>ningún eje</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>not in state %1</source>
      <translation>no en el estado %1</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>nothing was touched within %1</source>
      <translation>no se tocó nada en %1</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>something was touched on the way back: look at the setter</source>
      <translation>se tocó algo al volver: mire el palpador</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>the handwheel is selected: let it go first</source>
      <translation>el volante está elegido: suéltelo antes</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>the input is on already: is the setter touched, or its cable damaged?</source>
      <translation>la entrada ya está activa: ¿está tocado el palpador o dañado su cable?</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>the input probe is not read: check its terminal</source>
      <translation>la entrada probe no se lee: compruebe su borne</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>the input stays on %1 off the touch: look at stylus and cable</source>
      <translation>la entrada sigue activa a %1 del toque: mire la punta y el cable</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>the machine is in state %1</source>
      <translation>la máquina está en el estado %1</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>the second touch did not come: is the tool or the setter loose?</source>
      <translation>el segundo toque no llegó: ¿está floja la herramienta o el palpador?</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>the spindle turns: stop it first</source>
      <translation>el husillo gira: párelo antes</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>this machine has no tool setter: [setter] and the input probe in its file</source>
      <translation>esta máquina no tiene palpador de herramientas: [setter] y la entrada probe en su archivo</translation>
    </message>
    <message>
      <location filename="core/executor/touch_off.py" />
      <source>touch-off: %1</source>
      <translation>toque: %1</translation>
    </message>
    <message>
      <location filename="core/executor/watchdog.py" />
      <source>its thread has ended</source>
      <translation>su hilo terminó</translation>
    </message>
    <message>
      <location filename="core/executor/watchdog.py" />
      <source>its thread is stuck</source>
      <translation>su hilo está atorado</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>line itself</source>
      <translation>línea misma</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>next line</source>
      <translation>línea siguiente</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>no arc of that radius touches both between their ends</source>
      <translation>ningún arco de ese radio toca los dos entre sus extremos</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>of one of them %1</source>
      <translation>de uno de ellos %1</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>the %1 is too short</source>
      <translation>el %1 es demasiado corto</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>the chamfer would cross one of them</source>
      <translation>el chaflán cruzaría uno de ellos</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>the next line runs straight back</source>
      <translation>la línea siguiente regresa sobre sí misma</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>the next one runs straight back</source>
      <translation>el siguiente vuelve directamente atrás</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>they are too short for a chamfer of that length</source>
      <translation>son demasiado cortos para un chaflán de esa longitud</translation>
    </message>
    <message>
      <location filename="core/geometry/chamfer_and_rounding.py" />
      <source>they go on in one direction</source>
      <translation>siguen en una misma dirección</translation>
    </message>
    <message>
      <location filename="core/geometry/contour_offset.py" />
      <source>it runs straight back</source>
      <translation>regresa sobre sí mismo</translation>
    </message>
    <message>
      <location filename="core/geometry/contour_offset.py" />
      <source>its inside radius is not larger than that</source>
      <translation>su radio interior no es mayor que eso</translation>
    </message>
    <message>
      <location filename="core/geometry/contour_offset.py" />
      <source>nothing of it is left between its neighbours</source>
      <translation>no queda nada de él entre sus vecinos</translation>
    </message>
    <message>
      <location filename="core/geometry/contour_offset.py" />
      <source>the path beside another one would cut into it</source>
      <translation>la trayectoria junto a otro lo cortaría</translation>
    </message>
    <message>
      <location filename="core/geometry/contour_offset.py" />
      <source>the path beside it would cut into another one</source>
      <translation>la trayectoria junto a él cortaría a otro</translation>
    </message>
    <message>
      <location filename="core/geometry/rotation_frames.py" />
      <source>a projection angle is 90 degrees</source>
      <translation>un ángulo de proyección es de 90 grados</translation>
    </message>
    <message>
      <location filename="core/geometry/rotation_frames.py" />
      <source>a vector has no length</source>
      <translation>un vector no tiene longitud</translation>
    </message>
    <message>
      <location filename="core/geometry/rotation_frames.py" />
      <source>both vectors have one direction</source>
      <translation>ambos vectores tienen una dirección</translation>
    </message>
    <message>
      <location filename="core/geometry/rotation_frames.py" />
      <source>the first and the second point are the same</source>
      <translation>el primer punto y el segundo son el mismo</translation>
    </message>
    <message>
      <location filename="core/geometry/rotation_frames.py" />
      <source>the first and the third point are the same</source>
      <translation>el primer punto y el tercero son el mismo</translation>
    </message>
    <message>
      <location filename="core/geometry/rotation_frames.py" />
      <source>the three points lie on one line</source>
      <translation>los tres puntos están en una línea</translation>
    </message>
    <message>
      <location filename="core/interpreter/dialects.py" />
      <source>A %1 program begins with its first block.</source>
      <translation>Un programa %1 empieza por su primer bloque.</translation>
    </message>
    <message>
      <location filename="core/interpreter/dialects.py" />
      <source>A Klartext program needs a mill with X, Y and Z, and its [kinematics]; this machine is none.</source>
      <translation>Un programa Klartext necesita una fresadora con X, Y y Z, y su [kinematics]; esta máquina no lo es.</translation>
    </message>
    <message>
      <location filename="core/interpreter/dialects.py" />
      <source>A SINUMERIK turning program needs a lathe with X and Z; this machine has other axes.</source>
      <translation>Un programa SINUMERIK de torno necesita un torno con X y Z; esta máquina tiene otros ejes.</translation>
    </message>
    <message>
      <location filename="core/interpreter/dialects.py" />
      <source>An OmniTurn program needs a lathe with X, Z and C; this machine has other axes.</source>
      <translation>Un programa OmniTurn necesita un torno con X, Z y C; esta máquina tiene otros ejes.</translation>
    </message>
    <message>
      <location filename="core/interpreter/dialects.py" />
      <source>Choose the machine file of a lathe.</source>
      <translation>Elija el archivo de máquina de un torno.</translation>
    </message>
    <message>
      <location filename="core/interpreter/dialects.py" />
      <source>Choose the machine file of a mill: --machine ac-table-mill.</source>
      <translation>Elija el archivo de máquina de una fresadora: --machine ac-table-mill.</translation>
    </message>
    <message>
      <location filename="core/interpreter/dialects.py" />
      <source>Start it from the beginning.</source>
      <translation>Empiécelo desde el principio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>%1 of %2 has no value</source>
      <translation>%1 de %2 no tiene valor</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>A function is asked of too few or too many values</source>
      <translation>Una función recibe valores de menos o de más</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>It divides by zero</source>
      <translation>Divide por cero</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>The result is too large</source>
      <translation>El resultado es demasiado grande</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>arc cosine</source>
      <translation>arco coseno</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>arc sine</source>
      <translation>arco seno</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>arc tangent</source>
      <translation>arco tangente</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>common logarithm</source>
      <translation>logaritmo decimal</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>exclusive or</source>
      <translation>o exclusivo</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>greater or equal</source>
      <translation>mayor o igual</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>less or equal</source>
      <translation>menor o igual</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>natural logarithm</source>
      <translation>logaritmo natural</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>nearest whole number</source>
      <translation>entero más cercano</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>square root</source>
      <translation>raíz cuadrada</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>whole part</source>
      <translation>parte entera</translation>
    </message>
    <message>
      <location filename="core/interpreter/formula_values.py" />
      <source>whole quotient</source>
      <translation>cociente entero</translation>
    </message>
    <message>
      <location filename="core/interpreter/interpretation.py" />
      <source>The program makes more than %1 blocks or %2 executed lines.</source>
      <translation>El programa hace más de %1 bloques o %2 líneas ejecutadas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/coordinate_transformations.py" />
      <source>A datum shift of the rotary axis %1 is not built.</source>
      <translation>Un decalaje de origen del eje giratorio %1 no está hecho.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/coordinate_transformations.py" />
      <source>A factor of 0 leaves nothing.</source>
      <translation>Un factor de 0 no deja nada.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/coordinate_transformations.py" />
      <source>Turn the axis with L, or tell the plane.</source>
      <translation>Gire el eje con L o indique el plano.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/coordinate_transformations.py" />
      <source>Write SCL with a factor such as 0.99.</source>
      <translation>Escriba SCL con un factor como 0.99.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycle_moves.py" />
      <source>Cycle %1 moves at pitch times speed: nothing couples the spindle to Z here.</source>
      <translation>El ciclo %1 se mueve a paso por velocidad: aquí nada acopla el husillo a Z.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycle_moves.py" />
      <source>Cycle %1 needs Q%2.</source>
      <translation>El ciclo %1 necesita Q%2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycle_moves.py" />
      <source>Cycle %1 needs the spindle to turn.</source>
      <translation>El ciclo %1 necesita que gire el husillo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycle_moves.py" />
      <source>Q%1 of cycle %2 is no feed.</source>
      <translation>Q%1 del ciclo %2 no es un avance.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycle_moves.py" />
      <source>Start it with M3 before.</source>
      <translation>Arránquelo antes con M3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycle_moves.py" />
      <source>Use a floating holder.</source>
      <translation>Use un portamachos flotante.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycle_moves.py" />
      <source>Write a feed above zero.</source>
      <translation>Escriba un avance mayor que cero.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycle_moves.py" />
      <source>Write it behind CYCL DEF.</source>
      <translation>Escríbalo tras CYCL DEF.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>CYCL CALL POS of cycle %1</source>
      <translation>CYCL CALL POS del ciclo %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>CYCL CALL POS with a Z other than +0 is not built.</source>
      <translation>CYCL CALL POS con una Z distinta de +0 no está hecho.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>CYCL DEF %1</source>
      <translation>CYCL DEF %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>Cycle %1</source>
      <translation>Ciclo %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>Cycle %1 needs a machining cycle before it.</source>
      <translation>El ciclo %1 necesita antes un ciclo de mecanizado.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>No machining cycle has been told.</source>
      <translation>No se ha indicado ningún ciclo de mecanizado.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>Preset %1 is not kept here.</source>
      <translation>El preset %1 no se guarda aquí.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>Q%1 %2 is no number of places.</source>
      <translation>Q%1 %2 no es un número de lugares.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>The workpiece's zero is that of the machine file: touch off there.</source>
      <translation>El cero de la pieza es el del archivo de máquina: tóquelo allí.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>Write CYCL DEF before.</source>
      <translation>Escriba antes CYCL DEF.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>Write Z+0, and the surface into Q203.</source>
      <translation>Escriba Z+0, y la superficie en Q203.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>Write how many there are.</source>
      <translation>Escriba cuántos hay.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/cycles.py" />
      <source>Write its CYCL DEF before.</source>
      <translation>Escriba antes su CYCL DEF.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Correct the direction.</source>
      <translation>Corrija la dirección.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Correct them.</source>
      <translation>Corríjalos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Cycle 240 by diameter needs the angle of the tool's point.</source>
      <translation>El ciclo 240 por diámetro necesita el ángulo de la punta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Make Q202 larger.</source>
      <translation>Aumente Q202.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Q214 is not between 0 and 4.</source>
      <translation>Q214 no está entre 0 y 4.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Q239 is no pitch.</source>
      <translation>Q239 no es un paso.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>The depth Q201 %1 mm leads upwards.</source>
      <translation>La profundidad Q201 %1 mm va hacia arriba.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>The infeed of %1 mm takes too many.</source>
      <translation>La pasada de %1 mm da demasiadas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>The tool, the infeed or the feed of cycle 208 does not fit the hole.</source>
      <translation>La herramienta, la pasada o el avance del ciclo 208 no encaja en el agujero.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Write Q343=+0 and Q201.</source>
      <translation>Escriba Q343=+0 y Q201.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Write it with a minus.</source>
      <translation>Escríbala con menos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/hole_cycles.py" />
      <source>Write the pitch of the thread.</source>
      <translation>Escriba el paso de la rosca.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_interpreter.py" />
      <source>CYCL CALL</source>
      <translation>CYCL CALL</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_interpreter.py" />
      <source>Lower the counts of the repeats.</source>
      <translation>Baje los números de las repeticiones.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_interpreter.py" />
      <source>Put it into the same folder.</source>
      <translation>Póngalo en la misma carpeta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_interpreter.py" />
      <source>The program %1 is not beside this one.</source>
      <translation>El programa %1 no está junto a este.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>%1 line %2: %3</source>
      <translation>%1 línea %2: %3</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>A file holds one program.</source>
      <translation>Un archivo contiene un solo programa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>A program must not call itself.</source>
      <translation>Un programa no puede llamarse a sí mismo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>A subprogram must not call itself.</source>
      <translation>Un subprograma no debe llamarse a sí mismo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>Calls are nested more than %1 deep at LBL %2.</source>
      <translation>Las llamadas se anidan a más de %1 niveles en LBL %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>Correct the number, or write the label.</source>
      <translation>Corrija el número, o escriba la etiqueta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>END PGM is missing.</source>
      <translation>Falta END PGM.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>Give it another number.</source>
      <translation>Déle otro número.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>LBL %1 is nowhere in the program.</source>
      <translation>LBL %1 no está en ninguna parte del programa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>LBL %1 stands on line %2 too.</source>
      <translation>LBL %1 está también en la línea %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>Look whether the file is whole.</source>
      <translation>Vea si el archivo está completo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>Move it before END PGM.</source>
      <translation>Muévalo antes de END PGM.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>Programs call each other more than %1 deep at %2.</source>
      <translation>Los programas se llaman a más de %1 niveles en %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>The first block names program and unit.</source>
      <translation>El primer bloque nombra programa y unidad.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>The program begins as %1 and ends as %2.</source>
      <translation>El programa empieza como %1 y termina como %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>The subprogram LBL %1 has no LBL 0.</source>
      <translation>El subprograma LBL %1 no tiene LBL 0.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>This block stands behind END PGM.</source>
      <translation>Este bloque está después de END PGM.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>Write LBL 0 behind it.</source>
      <translation>Escriba LBL 0 después.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_program.py" />
      <source>Write the unit of the program in both.</source>
      <translation>Escriba en ambos la unidad del programa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/klartext_state.py" />
      <source>%1 does nothing here.</source>
      <translation>%1 no hace nada aquí.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/m_functions.py" />
      <source>M%1 stands twice in the block.</source>
      <translation>M%1 está dos veces en el bloque.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/m_functions.py" />
      <source>M%1 starts the spindle, and no TOOL CALL has given S.</source>
      <translation>M%1 arranca el husillo, y ningún TOOL CALL dio S.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/m_functions.py" />
      <source>M%1 while M128 is on.</source>
      <translation>M%1 con M128 activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/m_functions.py" />
      <source>More than one M function of the block steers the spindle.</source>
      <translation>Más de una función M del bloque manda el husillo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/m_functions.py" />
      <source>Switch it off with M129 before.</source>
      <translation>Apáguelo antes con M129.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/m_functions.py" />
      <source>TOOL %1</source>
      <translation>TOOL %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/m_functions.py" />
      <source>Take one out.</source>
      <translation>Quite una.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/m_functions.py" />
      <source>Write S behind TOOL CALL.</source>
      <translation>Escriba S tras TOOL CALL.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>A pocket is not milled in rapid.</source>
      <translation>Una caja no se fresa en rápido.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>Line %1.%2 of the cycle has no %3.</source>
      <translation>La línea %1.%2 del ciclo no tiene %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>Make it larger.</source>
      <translation>Auméntela.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>Take a smaller tool.</source>
      <translation>Tome una herramienta menor.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>The infeed of %1 mm takes %2 passes.</source>
      <translation>La pasada de %1 mm da %2 pasadas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>The tool is wider than the pocket.</source>
      <translation>La herramienta es más ancha que la caja.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>The tool is wider than the slot.</source>
      <translation>La herramienta es más ancha que la ranura.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>Write F in CYCL DEF.</source>
      <translation>Escriba F en CYCL DEF.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/older_cycles.py" />
      <source>Write it in CYCL DEF.</source>
      <translation>Escríbalo en CYCL DEF.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>%1 needs DR+ or DR-.</source>
      <translation>%1 necesita DR+ o DR-.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>%1 turns are the most.</source>
      <translation>%1 vueltas son el máximo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>A full circle takes two arcs, or C.</source>
      <translation>Un círculo entero necesita dos arcos, o C.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>An arc of R %1 mm does not reach over %2 mm.</source>
      <translation>Un arco de R %1 mm no alcanza %2 mm.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>CP goes round %1 times.</source>
      <translation>CP da %1 vueltas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Correct R or the end point.</source>
      <translation>Corrija R o el punto final.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Correct the end point or CC.</source>
      <translation>Corrija el punto final o CC.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Correct the end point.</source>
      <translation>Corrija el punto final.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Give both the same sign.</source>
      <translation>Dé a ambos el mismo signo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Go to the circle before.</source>
      <translation>Vaya antes al círculo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>IPA%1 and DR%2 go different ways.</source>
      <translation>IPA%1 y DR%2 van en sentidos distintos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>IPA+0 goes nowhere.</source>
      <translation>IPA+0 no va a ninguna parte.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>No CC has set a pole.</source>
      <translation>Ningún CC ha fijado un polo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Nothing moves before %1, so it has no direction to begin with.</source>
      <translation>Nada se mueve antes de %1, así que no tiene dirección con que empezar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Program a path before it.</source>
      <translation>Programe antes una trayectoria.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>The end lies %1 mm from the pole, the start %2 mm.</source>
      <translation>El final está a %1 mm del polo, el inicio a %2 mm.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>The end of %1 lies straight behind its start.</source>
      <translation>El final de %1 está justo detrás de su inicio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>The tool stands on the pole, so there is no circle.</source>
      <translation>La herramienta está en el polo, así que no hay círculo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Write CC with X and Y before.</source>
      <translation>Escriba antes CC con X e Y.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_elements.py" />
      <source>Write DR+ for counter-clockwise.</source>
      <translation>Escriba DR+ para sentido antihorario.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>%1 %2 mm: %3.</source>
      <translation>%1 %2 mm: %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>%1 needs a path in the working plane before it.</source>
      <translation>%1 necesita antes una trayectoria en el plano de trabajo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>%1 needs a path in the working plane behind it.</source>
      <translation>%1 necesita detrás una trayectoria en el plano de trabajo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>%1 stand elsewhere than the plane of line %2 asks.</source>
      <translation>%1 están en otra posición que la que pide el plano de la línea %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>%1 stands while radius compensation is on.</source>
      <translation>%1 está mientras la corrección de radio está activa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>A rotary axis moves while radius compensation is on.</source>
      <translation>Un eje giratorio se mueve con la corrección de radio activa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>APPR stands while radius compensation is on.</source>
      <translation>APPR está mientras la corrección de radio está activa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>End the contour with R0 before.</source>
      <translation>Termine antes el contorno con R0.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>End the contour with R0 or DEP before.</source>
      <translation>Termine antes el contorno con R0 o DEP.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>End the contour with R0 or DEP.</source>
      <translation>Termine el contorno con R0 o DEP.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>Make it smaller.</source>
      <translation>Hágala menor.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>Position them before the cut: L A+Q120 C+Q122 R0 FMAX, or TURN in the PLANE block.</source>
      <translation>Posiciónelos antes del corte: L A+Q120 C+Q122 R0 FMAX, o TURN en el bloque PLANE.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>Put it between two elements of the contour.</source>
      <translation>Póngalo entre dos elementos del contorno.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>R%1 stands while R%2 is on.</source>
      <translation>R%1 está mientras R%2 está activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>Start it with M3 or M4.</source>
      <translation>Arránquelo con M3 o M4.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>Take the word out.</source>
      <translation>Quite la palabra.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>The program ends while radius compensation is on.</source>
      <translation>El programa termina con la corrección de radio activa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>This feed move runs with the spindle at rest.</source>
      <translation>Este movimiento de avance corre con el husillo parado.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>This machine has no axis %1.</source>
      <translation>Esta máquina no tiene eje %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/path_functions.py" />
      <source>Write R0 between them.</source>
      <translation>Escriba R0 entre ellos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source> with %1</source>
      <translation> con %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>%1 %2 is not between %3 and %4.</source>
      <translation>%1 %2 no está entre %3 y %4.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>Correct the angle.</source>
      <translation>Corrija el ángulo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>Correct the points, vectors or angles.</source>
      <translation>Corrija los puntos, vectores o ángulos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>Look at points, angles and SYM.</source>
      <translation>Vea los puntos, los ángulos y SYM.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>M128 is on.</source>
      <translation>M128 está activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>MB MAX needs a software limit, and this machine has none along the tool.</source>
      <translation>MB MAX necesita un límite por programa, y esta máquina no lo tiene en el eje de la herramienta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>No TOOL CALL has named a tool axis.</source>
      <translation>Ningún TOOL CALL nombró un eje de herramienta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>No position of the rotary axes inside their ranges gives this plane%1.</source>
      <translation>Ninguna posición de los ejes giratorios dentro de su alcance da este plano%1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>TABLE ROT</source>
      <translation>TABLE ROT</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>The datum was shifted in the tilted system of line %1.</source>
      <translation>El origen se desplazó en el sistema inclinado de la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>This machine has no rotary axis %1.</source>
      <translation>Esta máquina no tiene eje giratorio %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>Where it was meant in the workpiece's system, write PLANE RESET STAY before TRANS DATUM.</source>
      <translation>Si era en el sistema de la pieza, escriba PLANE RESET STAY antes de TRANS DATUM.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>Where the table stands at the start decides which of two ways it swivels.</source>
      <translation>De dónde está la mesa al arrancar depende en cuál de dos sentidos bascula.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>Write MB with a length.</source>
      <translation>Escriba MB con una longitud.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>Write SYM+ or SYM-, or position the table before.</source>
      <translation>Escriba SYM+ o SYM-, o posicione antes la mesa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/plane_functions.py" />
      <source>Write TOOL CALL n Z before.</source>
      <translation>Escriba antes TOOL CALL n Z.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/q_functions.py" />
      <source>%1%2 has no value yet.</source>
      <translation>%1%2 aún no tiene valor.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/q_functions.py" />
      <source>Correct the formula.</source>
      <translation>Corrija la fórmula.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/q_functions.py" />
      <source>FN 18 with ID%1 NR%2 IDX%3</source>
      <translation>FN 18 con ID%1 NR%2 IDX%3</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/q_functions.py" />
      <source>Look at the conditions before this block.</source>
      <translation>Mire las condiciones antes de este bloque.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/q_functions.py" />
      <source>The program tells its error %1 and stops.</source>
      <translation>El programa avisa su error %1 y para.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/q_functions.py" />
      <source>The result %1 is larger than %2.</source>
      <translation>El resultado %1 es mayor que %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/q_functions.py" />
      <source>Write %1%2 = … before.</source>
      <translation>Escriba antes %1%2 = ….</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/radius_compensation.py" />
      <source>%1 has no way: the tool stands inside its arc.</source>
      <translation>%1 no tiene camino: la herramienta está dentro de su arco.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/radius_compensation.py" />
      <source>Begin farther off, or make R smaller.</source>
      <translation>Empiece más lejos o reduzca R.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/radius_compensation.py" />
      <source>Make R larger.</source>
      <translation>Aumente R.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/radius_compensation.py" />
      <source>R %1 mm of %2 is not over the tool radius %3 mm.</source>
      <translation>R %1 mm de %2 no supera el radio de herramienta %3 mm.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/radius_compensation.py" />
      <source>Take a smaller tool, or change the contour.</source>
      <translation>Tome una herramienta menor o cambie el contorno.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/radius_compensation.py" />
      <source>The tool radius of %1 mm does not fit here: %2.</source>
      <translation>El radio de herramienta de %1 mm no cabe aquí: %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/tool_call.py" />
      <source>Call it by its number, or write TOOL DEF before.</source>
      <translation>Llámela por su número o escriba antes TOOL DEF.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/tool_call.py" />
      <source>No tool is called "%1".</source>
      <translation>Ninguna herramienta se llama «%1».</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/tool_call.py" />
      <source>S%1 is over the spindle's %2 rpm.</source>
      <translation>S%1 pasa de las %2 rpm del husillo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/tool_call.py" />
      <source>Set the tool's offset.</source>
      <translation>Ponga la compensación de la herramienta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/tool_call.py" />
      <source>TOOL CALL while M128 is on.</source>
      <translation>TOOL CALL con M128 activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/tool_call.py" />
      <source>The tool axis %1</source>
      <translation>El eje de herramienta %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/tool_call.py" />
      <source>Tool %1 has no offset; 0 is used, and the machine will refuse to start.</source>
      <translation>La herramienta %1 no tiene compensación; se usa 0, y la máquina se negará a arrancar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/word_values.py" />
      <source>Correct the value.</source>
      <translation>Corrija el valor.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/word_values.py" />
      <source>F must be above zero.</source>
      <translation>F debe ser mayor que cero.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/word_values.py" />
      <source>No feed is in force.</source>
      <translation>No hay avance vigente.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/word_values.py" />
      <source>The last TOOL CALL has no F.</source>
      <translation>El último TOOL CALL no tiene F.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/word_values.py" />
      <source>Write F behind TOOL CALL.</source>
      <translation>Escriba F tras TOOL CALL.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/word_values.py" />
      <source>Write F or FMAX.</source>
      <translation>Escriba F o FMAX.</translation>
    </message>
    <message>
      <location filename="core/interpreter/klartext/word_values.py" />
      <source>Write a feed.</source>
      <translation>Escriba un avance.</translation>
    </message>
    <message>
      <location filename="core/interpreter/machine_requirements.py" />
      <source>a thread that pulls out in step with the spindle; end it in a groove</source>
      <translation>una rosca que sale en paso con el husillo; termínela en una ranura</translation>
    </message>
    <message>
      <location filename="core/interpreter/machine_requirements.py" />
      <source>constant surface speed; program the spindle in rpm with G97</source>
      <translation>velocidad superficial constante; programe el husillo en rpm con G97</translation>
    </message>
    <message>
      <location filename="core/interpreter/machine_requirements.py" />
      <source>input %1</source>
      <translation>la entrada %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/machine_requirements.py" />
      <source>milling in a switched plane</source>
      <translation>fresado en un plano cambiado</translation>
    </message>
    <message>
      <location filename="core/interpreter/machine_requirements.py" />
      <source>more axes than X and Z</source>
      <translation>más ejes que X y Z</translation>
    </message>
    <message>
      <location filename="core/interpreter/machine_requirements.py" />
      <source>output collet</source>
      <translation>la salida de la boquilla</translation>
    </message>
    <message>
      <location filename="core/interpreter/machine_requirements.py" />
      <source>output coolant</source>
      <translation>la salida del refrigerante</translation>
    </message>
    <message>
      <location filename="core/interpreter/machine_requirements.py" />
      <source>the C axis</source>
      <translation>el eje C</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>%1 is missing: under G90 and G73, I and K are the centre's coordinates.</source>
      <translation>Falta %1: con G90 y G73, I y K son las coordenadas del centro.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>A full circle takes I and K.</source>
      <translation>Un círculo completo lleva I y K.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>Add %1.</source>
      <translation>Agregue %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>Correct I and K.</source>
      <translation>Corrija I y K.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>I and K are distances from the start here.</source>
      <translation>Aquí I y K son distancias desde el inicio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>I and K are the centre's coordinates here.</source>
      <translation>Aquí I y K son las coordenadas del centro.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>R is %1, and the ends are so far apart that it takes %2 at least.</source>
      <translation>R es %1, y los extremos están tan separados que necesita al menos %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>The arc by R ends where it starts.</source>
      <translation>El arco por R termina donde empieza.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>The arc's radius is %1 at its start and %2 at its end.</source>
      <translation>El radio del arco es %1 al inicio y %2 al final.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/arc_moves.py" />
      <source>The centre of the arc is its start point.</source>
      <translation>El centro del arco es su punto de inicio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/c_axis.py" />
      <source>%1 is finer than the step of %2 degrees; %3 is used.</source>
      <translation>%1 es más fino que el paso de %2 grados; se usa %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/c_axis.py" />
      <source>At %1 rpm of C this feed is %2; %3 is the most.</source>
      <translation>A %1 rpm de C este avance es %2; lo más es %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/c_axis.py" />
      <source>C turns %1 degrees; the way of the slide at this feed needs %2.</source>
      <translation>C gira %1 grados; el camino del carro a este avance necesita %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/c_axis.py" />
      <source>Lower F or S.</source>
      <translation>Baje F o S.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/c_axis.py" />
      <source>Round the number.</source>
      <translation>Redondee el número.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/c_axis.py" />
      <source>The slide is fed by the turns of C, and no S has said how fast it turns.</source>
      <translation>El carro avanza por las vueltas de C, y ninguna S dijo qué tan rápido gira.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/c_axis.py" />
      <source>Turn C further, or raise F: the slide would stop on its way.</source>
      <translation>Gire más C, o suba F: el carro se detendría en el camino.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/c_axis.py" />
      <source>Write S on the line.</source>
      <translation>Escriba S en la línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/canned_cycles.py" />
      <source>%1 would make %2 %3; %4 are the most.</source>
      <translation>%1 haría %2 %3; lo más son %4.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/canned_cycles.py" />
      <source>Look for a lost decimal point in %1.</source>
      <translation>Busque un punto decimal perdido en %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/coarse_feeds.py" />
      <source>G%1 is not followed by a G92 with X and Z.</source>
      <translation>A G%1 no le sigue un G92 con X y Z.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/coarse_feeds.py" />
      <source>G36 stands elsewhere than its G35, which was at radius %1, Z %2.</source>
      <translation>G36 está en otro lugar que su G35, que estaba en radio %1, Z %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/coarse_feeds.py" />
      <source>Move back there before G36.</source>
      <translation>Regrese ahí antes de G36.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/coarse_feeds.py" />
      <source>The G92 behind G%1 says another place than radius %2, Z %3.</source>
      <translation>El G92 tras G%1 dice otro lugar que radio %2, Z %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/coarse_feeds.py" />
      <source>Write G92 with the present X and Z on the next line.</source>
      <translation>Escriba en la línea siguiente G92 con la X y la Z actuales.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>%1 (line %2)</source>
      <translation>%1 (línea %2)</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>%1 cannot make a corner: %2.</source>
      <translation>%1 no puede hacer una esquina: %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>%1 on line %2 is no straight move</source>
      <translation>%1 en la línea %2 no es una recta</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>A corner needs two straight moves in a row.</source>
      <translation>Una esquina necesita dos rectas seguidas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>Lines %1 and %2 run in one direction: there is no corner to cut.</source>
      <translation>Las líneas %1 y %2 van en una misma dirección: no hay esquina que cortar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>Take C or R out.</source>
      <translation>Quite C o R.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>The two moves run in one direction: there is no corner to cut.</source>
      <translation>Los dos movimientos van en una misma dirección: no hay esquina que cortar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>an arc</source>
      <translation>un arco</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>another motion</source>
      <translation>otro movimiento</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>it takes %1 of %2, which has %3 left</source>
      <translation>ocupa %1 de %2, al que le quedan %3</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>it takes %1 of the move on line %2, which has %3 left</source>
      <translation>ocupa %1 del movimiento de la línea %2, al que le quedan %3</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>no move follows</source>
      <translation>no sigue ningún movimiento</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>no move follows before %1</source>
      <translation>no sigue ningún movimiento antes de %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>no straight line</source>
      <translation>ninguna recta</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>nose compensation ends before the next move</source>
      <translation>la compensación de punta termina antes del movimiento siguiente</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>the contour ends here</source>
      <translation>el contorno termina aquí</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>the move on line %1 has no length</source>
      <translation>el movimiento de la línea %1 no tiene largo</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>the next move</source>
      <translation>el movimiento siguiente</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>the next move is an arc</source>
      <translation>el movimiento siguiente es un arco</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>the next move, on line %1, is %2</source>
      <translation>el movimiento siguiente, en la línea %1, es %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/corners.py" />
      <source>this move</source>
      <translation>este movimiento</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>%1 and its like do not count in the contour of G%2.</source>
      <translation>%1 y similares no cuentan en el contorno de G%2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>%1 cannot stand in a contour</source>
      <translation>%1 no puede estar en un contorno</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>A contour holds moves, arcs and corners written out.</source>
      <translation>Un contorno contiene movimientos, arcos y esquinas escritos completos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>Correct the line.</source>
      <translation>Corrija la línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>Finish with a contour of its own.</source>
      <translation>Termine con un contorno propio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>G%1 cannot stand in a contour</source>
      <translation>G%1 no puede estar en un contorno</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>Nose compensation cannot be switched in a contour</source>
      <translation>La compensación de punta no se puede cambiar en un contorno</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>Take it out.</source>
      <translation>Quítelo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>The contour cannot be read here</source>
      <translation>El contorno no se puede leer aquí</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>The contour changes modes or coordinates; after the cycle those before it hold again.</source>
      <translation>El contorno cambia modos o coordenadas; tras el ciclo vuelven a valer los de antes.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>The contour of G%1 has no line or arc.</source>
      <translation>El contorno de G%1 no tiene línea ni arco.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>The first line of a contour is its first point, which takes no arc and no corner</source>
      <translation>La primera línea de un contorno es su primer punto, que no lleva arco ni esquina</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>Write X and Z of the point alone.</source>
      <translation>Escriba sólo la X y la Z del punto.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/cycle_contour.py" />
      <source>Write its points.</source>
      <translation>Escriba sus puntos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/drilling_cycles.py" />
      <source>%1 lies in the hole, not before the depth of the first peck.</source>
      <translation>%1 está dentro del barreno, no antes de la profundidad del primer picoteo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/drilling_cycles.py" />
      <source>Correct Z, or start farther out.</source>
      <translation>Corrija Z, o empiece más afuera.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/drilling_cycles.py" />
      <source>R is where the drill comes out of the hole.</source>
      <translation>R es donde la broca sale del barreno.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/drilling_cycles.py" />
      <source>The bottom of the hole at %1 is not beyond the start point at %2.</source>
      <translation>El fondo del barreno en %1 no está más allá del punto de inicio en %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/dwell.py" />
      <source>The drive of C does not tell of its arrival, which takes %1 s from here.</source>
      <translation>El servo de C no avisa su llegada, que desde aquí tarda %1 s.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/dwell.py" />
      <source>Write G04F%1 after it, or longer.</source>
      <translation>Escriba después G04F%1, o más.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Feed %1 is over %2 at %3 rpm, which is %4.</source>
      <translation>El avance %1 pasa de %2 a %3 rpm, que es %4.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Feed %1 is over %2.</source>
      <translation>El avance %1 pasa de %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Feed %1 is very high for cutting.</source>
      <translation>El avance %1 es muy alto para cortar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>G96 is active and no S has given a surface speed.</source>
      <translation>G96 está activo y ninguna S dio una velocidad superficial.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Look at F and at G94/G95.</source>
      <translation>Vea la F y G94/G95.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Look for a lost decimal point, or G94 for G95.</source>
      <translation>Busque un punto decimal perdido, o G94 en vez de G95.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Look for a lost decimal point.</source>
      <translation>Busque un punto decimal perdido.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Start it with M03 or M04, or use G94.</source>
      <translation>Arránquelo con M03 o M04, o use G94.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>The move has no feed.</source>
      <translation>El movimiento no tiene avance.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>The spindle stands, and the move runs at %1.</source>
      <translation>El husillo está parado, y el movimiento corre a %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>This move takes %1 s at %2.</source>
      <translation>Este movimiento tarda %1 s a %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Write F on this line or before it.</source>
      <translation>Escriba F en esta línea o antes.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>Write S beside G96.</source>
      <translation>Escriba S junto a G96.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>a feed per revolution</source>
      <translation>un avance por vuelta</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/feeds.py" />
      <source>constant surface speed</source>
      <translation>velocidad superficial constante</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>%1 has no LF.</source>
      <translation>%1 no tiene LF.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>A subroutine must not call itself.</source>
      <translation>Una subrutina no debe llamarse a sí misma.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Add G75 or G78, or take it out.</source>
      <translation>Agregue G75 o G78, o quítelo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Add LF where the loop ends.</source>
      <translation>Agregue LF donde termina el lazo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Add LS with a count, or take it out.</source>
      <translation>Agregue LS con una cuenta, o quítelo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Add M99 at its end.</source>
      <translation>Agregue M99 a su final.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>LF ends no loop.</source>
      <translation>LF no termina ningún lazo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>M30 goes before the subroutines.</source>
      <translation>M30 va antes de las subrutinas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>M99 ends no subroutine here.</source>
      <translation>M99 no termina aquí ninguna subrutina.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Move it before M30, or start a subroutine with }n.</source>
      <translation>Muévalo antes de M30, o empiece una subrutina con }n.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>RF ends no contour here.</source>
      <translation>RF no termina aquí ningún contorno.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Subroutine %1 begins on line %2 already.</source>
      <translation>La subrutina %1 ya empieza en la línea %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Subroutine %1 has no M99.</source>
      <translation>La subrutina %1 no tiene M99.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Subroutine %1 is called, and no }%2 begins it.</source>
      <translation>Se llama la subrutina %1, y ningún }%2 la empieza.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Subroutines call each other more than %1 deep.</source>
      <translation>Las subrutinas se llaman unas a otras a más de %1 niveles.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>The contour of G%1 has no RF.</source>
      <translation>El contorno de G%1 no tiene RF.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>The main program ends without M30 or M02.</source>
      <translation>El programa principal termina sin M30 ni M02.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>This line stands after the end of the program and is in no subroutine.</source>
      <translation>Esta línea está después del final del programa y en ninguna subrutina.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Write RF alone on the line after it, or P with the number of a subroutine.</source>
      <translation>Escriba RF solo en la línea que sigue, o P con el número de una subrutina.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>Write it after M30.</source>
      <translation>Escríbalo después de M30.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/loops_and_subroutines.py" />
      <source>}%1 has no M99 before this line.</source>
      <translation>}%1 no tiene M99 antes de esta línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/m_codes.py" />
      <source>%1 is defined, and not switched on in the machine file.</source>
      <translation>%1 está definido, y no activado en el archivo de máquina.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/m_codes.py" />
      <source>%1 is no code of this machine. %2</source>
      <translation>%1 no es código de esta máquina. %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/m_codes.py" />
      <source>Set enabled = true for %1 under [m_codes].</source>
      <translation>Ponga enabled = true para %1 en [m_codes].</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/m_codes.py" />
      <source>The machine file assigns the outputs.</source>
      <translation>El archivo de máquina asigna las salidas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/mdi_line.py" />
      <source>%1 rounds the corner with the next move</source>
      <translation>%1 redondea la esquina con el movimiento siguiente</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/mdi_line.py" />
      <source>/ leaves a line of a program out, and there is nothing to leave out</source>
      <translation>/ salta una línea de un programa, y no hay nada que saltar</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/mdi_line.py" />
      <source>Write it in a program.</source>
      <translation>Escríbalo en un programa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>%1 cannot follow this move.</source>
      <translation>%1 no puede seguir este movimiento.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>%1 stands while G%2 is on.</source>
      <translation>%1 está con G%2 activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>%1 with a nose radius of %2 cannot follow this move: %3.</source>
      <translation>%1 con radio de punta %2 no puede seguir este movimiento: %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>%1, less than the nose radius %2.</source>
      <translation>%1, menos que el radio de punta %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>%1, less than twice the nose radius %2.</source>
      <translation>%1, menos que el doble del radio de punta %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>A subroutine is called while G%1 is on.</source>
      <translation>Se llama una subrutina con G%1 activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Approach on a straight line with D.</source>
      <translation>Entre en línea recta con D.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Choose another way for the %1, or the other side.</source>
      <translation>Elija otro camino para la %1, o el otro lado.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>D belongs on the first move after G41 or G42 alone.</source>
      <translation>D va sólo en el primer movimiento tras G41 o G42.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>D changes while G%1 is on.</source>
      <translation>D cambia con G%1 activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Enter the nose radius among the offsets.</source>
      <translation>Ponga el radio de punta entre las compensaciones.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Enter the nose radius without a sign; G41 and G42 say the side.</source>
      <translation>Ponga el radio de punta sin signo; G41 y G42 dicen el lado.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>G%1 stands in a subroutine.</source>
      <translation>G%1 está en una subrutina.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Keep twice the nose radius off the part.</source>
      <translation>Quede a dos veces el radio de punta de la pieza.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Move farther off the part.</source>
      <translation>Aléjese más de la pieza.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Move off the part and write G40 before it.</source>
      <translation>Salga de la pieza y escriba G40 antes.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Move off the part on a straight line.</source>
      <translation>Salga de la pieza en línea recta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Move off the part.</source>
      <translation>Salga de la pieza.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>No move follows the contour between the approach and the departure of %1.</source>
      <translation>Ningún movimiento sigue el contorno entre la entrada y la salida de %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>On the %1 the nose of G%2 cuts into the part.</source>
      <translation>En la %1 la punta de G%2 corta la pieza.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Plane switching stands while G%1 is on.</source>
      <translation>Hay cambio de plano con G%1 activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>R of D%1 is 0: G%2 compensates nothing.</source>
      <translation>La R de D%1 es 0: G%2 no compensa nada.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>R of D%1 is negative.</source>
      <translation>La R de D%1 es negativa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Take a smaller nose, or change the contour.</source>
      <translation>Use una punta menor, o cambie el contorno.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>The %1 %2 %3 off the part</source>
      <translation>La %1 %2 %3 de la pieza</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>The %1 is %2 long, less than the nose radius %3.</source>
      <translation>La %1 mide %2, menos que el radio de punta %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>The departure, the last move before G40, has no length.</source>
      <translation>La salida, el último movimiento antes de G40, no tiene largo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>The departure, the move before G40, is no straight line.</source>
      <translation>La salida, el movimiento antes de G40, no es una recta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>The first move after G%1 on line %2 is no straight line.</source>
      <translation>El primer movimiento tras G%1 en la línea %2 no es una recta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>The first move after G%1 on line %2 names no D.</source>
      <translation>El primer movimiento tras G%1 en la línea %2 no nombra D.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>The program ends while G%1 is on.</source>
      <translation>El programa termina con G%1 activo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Write Dn: its R is the nose radius.</source>
      <translation>Escriba Dn: su R es el radio de punta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Write G40 before it.</source>
      <translation>Escriba G40 antes.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Write the compensated contour in the main program.</source>
      <translation>Escriba el contorno compensado en el programa principal.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/nose_compensation.py" />
      <source>Write the contour between them.</source>
      <translation>Escriba el contorno entre ellos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_interpreter.py" />
      <source>Begin with G90G94F300.</source>
      <translation>Empiece con G90G94F300.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_interpreter.py" />
      <source>Lower the counts of the loops.</source>
      <translation>Baje las cuentas de los lazos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_interpreter.py" />
      <source>Neither G90 (absolute) nor G91 (incremental) is in force.</source>
      <translation>No está vigente ni G90 (absoluto) ni G91 (incremental).</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_interpreter.py" />
      <source>Say one of them first.</source>
      <translation>Diga primero uno de ellos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_interpreter.py" />
      <source>The first line must say G90 (absolute) or G91 (incremental).</source>
      <translation>La primera línea debe decir G90 (absoluto) o G91 (incremental).</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_interpreter.py" />
      <source>The program names neither G70 nor G71; it runs in millimetres, in which the control counts.</source>
      <translation>El programa no dice G70 ni G71; corre en milímetros, que es en lo que cuenta el control.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_interpreter.py" />
      <source>Write G70 or G71 on the first line.</source>
      <translation>Escriba G70 o G71 en la primera línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>%1 is a comment without its ~, and so are the lines up to (END): nothing is milled.</source>
      <translation>%1 es un comentario sin su ~, y también las líneas hasta (END): no se fresa nada.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>A comment stands inside a loop.</source>
      <translation>Hay un comentario dentro de un lazo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>A comment stands on a line by itself.</source>
      <translation>Hay un comentario solo en una línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>A comment stands on the line that starts a subroutine.</source>
      <translation>Hay un comentario en la línea que empieza una subrutina.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Move it before LS.</source>
      <translation>Muévalo antes de LS.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Move it down a line.</source>
      <translation>Bájelo una línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Plane switching on line %1 has no (END).</source>
      <translation>El cambio de plano de la línea %1 no tiene (END).</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Press Return after it.</source>
      <translation>Oprima Return después.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Put it on a line with a command.</source>
      <translation>Póngalo en una línea con una orden.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Save the file with the line ends of this machine.</source>
      <translation>Guarde el archivo con los finales de línea de esta máquina.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Take it out for the original control.</source>
      <translation>Quítelo para el control original.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>The comment holds more than letters, digits and blanks.</source>
      <translation>El comentario contiene más que letras, números y espacios.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>The last line has no line end.</source>
      <translation>La última línea no tiene final de línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>The line is blank.</source>
      <translation>La línea está en blanco.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>The lines end in a carriage return.</source>
      <translation>Las líneas terminan en retorno de carro.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>The program is empty.</source>
      <translation>El programa está vacío.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>The tool number has a leading zero.</source>
      <translation>El número de herramienta lleva un cero delante.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Use plain text.</source>
      <translation>Use texto simple.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Write (END) alone on a line.</source>
      <translation>Escriba (END) solo en una línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Write (~%1.</source>
      <translation>Escriba (~%1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Write G90 and M30.</source>
      <translation>Escriba G90 y M30.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_program.py" />
      <source>Write T1 for T01.</source>
      <translation>Escriba T1 en vez de T01.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>%1 and %2 cannot act on one line.</source>
      <translation>%1 y %2 no pueden actuar en una línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>%1 has no meaning here. %2</source>
      <translation>%1 no significa nada aquí. %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>%1 is no code of this control. %2</source>
      <translation>%1 no es código de este control. %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>%1 looks like plane switching; (~PLXC) and (~PLZC) stand alone on a line.</source>
      <translation>%1 parece cambio de plano; (~PLXC) y (~PLZC) van solos en una línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>Add %1 with its number.</source>
      <translation>Agregue %1 con su número.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>Keep one of them.</source>
      <translation>Deje uno de ellos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>Look it up.</source>
      <translation>Búsquelo en la página del lenguaje.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>Put it on a line of its own.</source>
      <translation>Póngalo en su propia línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>Split the line.</source>
      <translation>Divida la línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>Take '/' out.</source>
      <translation>Quite '/'.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>Take it out or add its code.</source>
      <translation>Quítelo o agregue su código.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>The line %1.</source>
      <translation>La línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>Write it alone.</source>
      <translation>Escríbalo solo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>deletes %1, without which the rest has no meaning</source>
      <translation>borra %1, sin lo cual el resto no tiene sentido</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>holds %1 besides %2, which stands alone</source>
      <translation>contiene %1 además de %2, que va solo</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>holds %1 twice</source>
      <translation>contiene %1 dos veces</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>holds %1 without %2</source>
      <translation>contiene %1 sin %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>holds %1, which nothing on it takes</source>
      <translation>contiene %1, que nada en ella usa</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>holds two M codes</source>
      <translation>contiene dos códigos M</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/omniturn_statement.py" />
      <source>holds two codes of one group (%1)</source>
      <translation>contiene dos códigos de un grupo (%1)</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>(~%1) needs the tool on the negative X side, and X is %2.</source>
      <translation>(~%1) necesita la herramienta del lado X negativo, y X es %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>Correct it.</source>
      <translation>Corríjalo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>D belongs to (~PLZC).</source>
      <translation>D pertenece a (~PLZC).</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>D comes where Y is %1: it would move Y.</source>
      <translation>D viene donde Y es %1: movería Y.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>D must be a diameter over 0.</source>
      <translation>D debe ser un diámetro mayor que 0.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>H belongs to (~PLXC).</source>
      <translation>H pertenece a (~PLXC).</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>H comes after a move or F.</source>
      <translation>H viene después de un movimiento o F.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>I and J are the centre's coordinates.</source>
      <translation>I y J son las coordenadas del centro.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>Move to X- before it.</source>
      <translation>Muévase antes a X-.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>The tool stands meanwhile; lead it past the axis.</source>
      <translation>La herramienta se detiene entretanto; llévela al lado del eje.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>The tool's centre line stands H beside the axis.</source>
      <translation>La línea central de la herramienta está a H del eje.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>The way comes within %1 of the axis; with this H the tool reaches %2.</source>
      <translation>El camino pasa a %1 del eje; con esta H la herramienta alcanza %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>The way leads through the axis: C turns by %1 degrees there.</source>
      <translation>El camino pasa por el eje: ahí C gira %1 grados.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>Write it first.</source>
      <translation>Escríbalo primero.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>Write it where Y is 0.</source>
      <translation>Escríbalo donde Y es 0.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/plane_switching.py" />
      <source>Z%1 lies beyond the centre: Z is the diameter that the tip touches.</source>
      <translation>Z%1 está más allá del centro: Z es el diámetro que toca la punta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/program_size.py" />
      <source>The program executes %1 lines; %2 are the most.</source>
      <translation>El programa ejecuta %1 líneas; lo más son %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/program_size.py" />
      <source>The program makes %1 blocks; %2 are the most.</source>
      <translation>El programa hace %1 bloques; lo más son %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/program_size.py" />
      <source>about 10^%1</source>
      <translation>cerca de 10^%1</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>%1 finds no unbroken way along the contour at the distance U.</source>
      <translation>%1 no halla un camino continuo junto al contorno a la distancia U.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>%1 leaves nothing of the box to cut.</source>
      <translation>%1 no deja nada de la caja por cortar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>%1 passes beside a contour of %2 lines and arcs are too many to work out.</source>
      <translation>%1 pasadas junto a un contorno de %2 líneas y arcos son demasiadas para calcular.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Both ends of the contour have the %1 of the start point: there is no area to cut.</source>
      <translation>Los dos extremos del contorno tienen la %1 del punto de inicio: no hay área que cortar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Correct %1 or the start point.</source>
      <translation>Corrija %1 o el punto de inicio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Look whether the tool can do so.</source>
      <translation>Vea si la herramienta puede hacerlo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Look whether the tool fits.</source>
      <translation>Vea si la herramienta cabe.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Lower U, or open the narrow place.</source>
      <translation>Baje U, o abra el paso estrecho.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Move the start point away from the contour.</source>
      <translation>Aleje del contorno el punto de inicio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Move the start point beyond both ends.</source>
      <translation>Ponga el punto de inicio más allá de ambos extremos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>On the way from the start point to the contour and back the tool comes nearer to it than U.</source>
      <translation>En el camino del punto de inicio al contorno y de regreso la herramienta se acerca a menos de U.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Raise I, or describe the contour in fewer moves.</source>
      <translation>Suba I, o describa el contorno en menos movimientos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Run it with fewer, longer moves.</source>
      <translation>Córralo con menos movimientos, más largos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>Start farther from the contour in X.</source>
      <translation>Empiece más lejos del contorno en X.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>The box has no size along %1: its corner lies at the start point.</source>
      <translation>La caja no tiene medida en %1: su esquina está en el punto de inicio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>The contour has %1 lines and arcs; %2 are the most.</source>
      <translation>El contorno tiene %1 líneas y arcos; lo más son %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>The contour leaves nothing to cut between it and the start point.</source>
      <translation>El contorno no deja nada que cortar entre él y el punto de inicio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>The contour rises and falls again: the tool plunges into the material behind the rise.</source>
      <translation>El contorno sube y vuelve a bajar: la herramienta se hunde en el material detrás de la subida.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>The contour runs back along Z: behind that edge the pass along it cuts all that is there.</source>
      <translation>El contorno regresa en Z: detrás de ese filo la pasada corta todo lo que hay.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>The start point lies between the ends of the contour in %1, not outside of both.</source>
      <translation>El punto de inicio está entre los extremos del contorno en %1, no fuera de ambos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/roughing_cycles.py" />
      <source>U is less than the way from the start to X.</source>
      <translation>U es menor que el camino del inicio a X.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/spindle_speed.py" />
      <source>Correct one of them.</source>
      <translation>Corrija uno de ellos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/spindle_speed.py" />
      <source>G76 (%1 rpm) is over G77 (%2 rpm).</source>
      <translation>G76 (%1 rpm) pasa de G77 (%2 rpm).</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/straight_moves.py" />
      <source>%1 is finer than the step of %2 %3; %4 is used.</source>
      <translation>%1 es más fino que el paso de %2 %3; se usa %4.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/straight_moves.py" />
      <source>%1 is finer than the step; %2 is used.</source>
      <translation>%1 es más fino que el paso; se usa %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/straight_moves.py" />
      <source>The first move after %1 lacks %2.</source>
      <translation>Al primer movimiento tras %1 le falta %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/straight_moves.py" />
      <source>This move is a rapid because of the G00 beside the comment on line %1.</source>
      <translation>Este movimiento es rápido por el G00 junto al comentario de la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/straight_moves.py" />
      <source>Write G01 if it is meant to cut.</source>
      <translation>Escriba G01 si debe cortar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/straight_moves.py" />
      <source>Write both X and Z, or G92 before it.</source>
      <translation>Escriba X y Z, o G92 antes.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/straight_moves.py" />
      <source>the T on line %1</source>
      <translation>la T de la línea %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>%1 leaves nothing to cut: %2.</source>
      <translation>%1 no deja nada que cortar: %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>%1 lies on the other side of the spindle axis: %2.</source>
      <translation>%1 está del otro lado del eje del husillo: %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>A larger I takes fewer; look at I and at the X where the tool starts.</source>
      <translation>Una I mayor hace menos; vea I y la X en que empieza la herramienta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>At %1 rpm this lead is %2; %3 is the most.</source>
      <translation>A %1 rpm este paso es %2; lo más es %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>Correct Z, or move away before the G33.</source>
      <translation>Corrija Z, o aléjese antes del G33.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>G35 allows more.</source>
      <translation>G35 permite más.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>G35F2 allows more.</source>
      <translation>G35F2 permite más.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>K is missing, and %1 is there.</source>
      <translation>Falta K, y está %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>Look at the sign of X and at where the tool starts.</source>
      <translation>Vea el signo de X y dónde empieza la herramienta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>Start at the depth of the first pass.</source>
      <translation>Empiece a la profundidad de la primera pasada.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>Start farther away from Z.</source>
      <translation>Empiece más lejos de Z.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>Start farther away, or lower S.</source>
      <translation>Empiece más lejos, o baje S.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>The flank angle moves the start of the last pass beyond its end.</source>
      <translation>El ángulo de flanco lleva el inicio de la última pasada más allá de su final.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>The run-up is %1; the slide needs %2 to reach the speed of the lead.</source>
      <translation>La carrera de arranque es %1; el carro necesita %2 para llegar a la velocidad del paso.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>The thread ends at the Z where it starts.</source>
      <translation>La rosca termina en la Z en que empieza.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>The thread takes %1 passes.</source>
      <translation>La rosca hace %1 pasadas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>The thread would take %1 passes; %2 are the most.</source>
      <translation>La rosca haría %1 pasadas; lo más son %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>Was K%1 meant?</source>
      <translation>¿Se quiso decir K%1?</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/threading_cycles.py" />
      <source>the tool stands at radius %1</source>
      <translation>la herramienta está en radio %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/tools_and_offsets.py" />
      <source>%1 have no offset; 0 is used, and the machine will refuse to start.</source>
      <translation>%1 no tienen compensación; se usa 0 y la máquina no arrancará.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/tools_and_offsets.py" />
      <source>G96 is active at a tool change: the spindle drive has to follow every jump of X.</source>
      <translation>G96 está activo en un cambio de herramienta: el husillo tiene que seguir cada salto de X.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/tools_and_offsets.py" />
      <source>No T follows this G10, so the work shift never takes effect.</source>
      <translation>Ninguna T sigue a este G10, así que el desplazamiento nunca actúa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/tools_and_offsets.py" />
      <source>Put G97 before the T.</source>
      <translation>Ponga G97 antes de la T.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/tools_and_offsets.py" />
      <source>Put it before a T.</source>
      <translation>Póngalo antes de una T.</translation>
    </message>
    <message>
      <location filename="core/interpreter/omniturn/tools_and_offsets.py" />
      <source>Set their offsets.</source>
      <translation>Ponga sus compensaciones.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/loop_passes.py" />
      <source>Line %1 is run %2 times; there is no pass %3.</source>
      <translation>La línea %1 corre %2 veces; no hay pasada %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/loop_passes.py" />
      <source>Line %1 is run more than %2 times: choose the line that begins the loop.</source>
      <translation>La línea %1 corre más de %2 veces: elija la línea que empieza el lazo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/loop_passes.py" />
      <source>The program never comes to line %1.</source>
      <translation>El programa nunca llega a la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_approach.py" />
      <source>%1 OFF</source>
      <translation>%1 APAGADO</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_approach.py" />
      <source>%1 ON</source>
      <translation>%1 ENCENDIDO</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>Line %1 %2</source>
      <translation>La línea %1 %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>Line %1 is empty.</source>
      <translation>La línea %1 está vacía.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>There is no line %1; the program has %2.</source>
      <translation>No hay línea %1; el programa tiene %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>describes the contour of line %1.</source>
      <translation>describe el contorno de la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>is in subroutine %1.</source>
      <translation>está en la subrutina %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>is in the corner of line %1.</source>
      <translation>está en la esquina de la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>is in the plane switching that begins on line %1.</source>
      <translation>está en el cambio de plano que empieza en la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>is inside the loop of lines %1 to %2.</source>
      <translation>está dentro del lazo de las líneas %1 a %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>is under the nose compensation that begins on line %1.</source>
      <translation>está bajo la compensación de punta que empieza en la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/restart_lines.py" />
      <source>stands after the end of the program.</source>
      <translation>está después del final del programa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>A tap stands in its thread there.</source>
      <translation>Allí hay un machuelo en su rosca.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>A threading tool stands in its thread there.</source>
      <translation>Allí hay una herramienta de roscar en su rosca.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Line %1</source>
      <translation>Línea %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Line %1 begins in metal that %2 would have had to cut.</source>
      <translation>La línea %1 empieza en metal que debieron cortar antes: %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Line %1 begins in the work, and no sure way leads there. %2</source>
      <translation>La línea %1 empieza dentro de la pieza y ningún camino seguro lleva allí. %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Line %1 depends on the input that line %2 asks.</source>
      <translation>La línea %1 depende de la entrada que pregunta la línea %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Line %1 is in plane switching.</source>
      <translation>La línea %1 está en un cambio de plano.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Line %1 is no place to go on: %2</source>
      <translation>La línea %1 no es lugar para seguir: %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Line %1 is under nose compensation or in a corner.</source>
      <translation>La línea %1 está bajo compensación de punta o en una esquina.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Nothing has moved before line %1: start the program from its first line.</source>
      <translation>Nada se mueve antes de la línea %1: empiece el programa desde su primera línea.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>The program ends on line %1, before line %2.</source>
      <translation>El programa termina en la línea %1, antes de la línea %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>The program has errors before line %1.</source>
      <translation>El programa tiene errores antes de la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>Where the slides stand at line %1 depends on where they stood at Cycle Start.</source>
      <translation>Dónde están los carros en la línea %1 depende de dónde estaban en el inicio de ciclo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>lines %1 to %2</source>
      <translation>líneas %1 a %2</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>what input %1 answered on line %2 is not known.</source>
      <translation>no se sabe qué respondió la entrada %1 en la línea %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/restart/state_rebuild.py" />
      <source>what the input of line %1 answered is not known.</source>
      <translation>no se sabe qué respondió la entrada de la línea %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>A corner needs two moves in a row.</source>
      <translation>Una esquina necesita dos movimientos seguidos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>CHF, CHR and RND take G1, G2 and G3.</source>
      <translation>CHF, CHR y RND admiten G1, G2 y G3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>Give another end point.</source>
      <translation>Dé otro punto final.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>Write G18 before it.</source>
      <translation>Escriba antes G18.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>corners of X and Z need G18</source>
      <translation>las esquinas de X y Z necesitan G18</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>it takes %1 mm of the move on line %2, which has %3 mm</source>
      <translation>ocupa %1 mm del movimiento de la línea %2, que tiene %3 mm</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>lines %1 and %2 run in one direction: there is no corner to cut.</source>
      <translation>las líneas %1 y %2 van en una misma dirección: no hay esquina que cortar.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>the block is no line or arc</source>
      <translation>el bloque no es recta ni arco</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>the next move, on line %1, is no line or arc of X and Z</source>
      <translation>el próximo movimiento, en la línea %1, no es recta ni arco de X y Z</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/chamfers_and_rounds.py" />
      <source>the size of a corner</source>
      <translation>el tamaño de una esquina</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/control_structures.py" />
      <source>%1 has no end.</source>
      <translation>%1 no tiene fin.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/control_structures.py" />
      <source>%1 has nothing that it belongs to.</source>
      <translation>%1 no pertenece a nada.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/control_structures.py" />
      <source>%1 is no variable of this program.</source>
      <translation>%1 no es una variable de este programa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/control_structures.py" />
      <source>Correct the label, or the direction of the jump.</source>
      <translation>Corrija la etiqueta o la dirección del salto.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/control_structures.py" />
      <source>Look at the beginning of the structure.</source>
      <translation>Mire el principio de la estructura.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/control_structures.py" />
      <source>Write DEF INT %1 before it.</source>
      <translation>Escriba antes DEF INT %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/control_structures.py" />
      <source>Write its end behind it.</source>
      <translation>Escriba su fin detrás.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/control_structures.py" />
      <source>the label %1 is not where %2 looks for it.</source>
      <translation>la etiqueta %1 no está donde %2 la busca.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>%1 belongs to an arc, and G%2 is in force.</source>
      <translation>%1 pertenece a un arco, y está vigente G%2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>%1: %2 needs a rotary axis.</source>
      <translation>%1: %2 necesita un eje giratorio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>C of this machine counts -360 to +360; write AC( ) or IC( ).</source>
      <translation>El C de esta máquina cuenta de -360 a +360; escriba AC( ) o IC( ).</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>Correct the target or the offset of C.</source>
      <translation>Corrija el destino o el desplazamiento de C.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>G96 is in force and no S has given a surface speed.</source>
      <translation>G96 está vigente y ninguna S dio una velocidad superficial.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>Start it with S and M3 or M4, or use G94.</source>
      <translation>Arránquelo con S y M3 o M4, o use G94.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>Write %1=AC( ) or %2=IC( ).</source>
      <translation>Escriba %1=AC( ) o %2=IC( ).</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>Write F. Between G94 and G95 the old value is forgotten.</source>
      <translation>Escriba F. Entre G94 y G95 se olvida el valor anterior.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>Write G2 or G3, or take it out.</source>
      <translation>Escriba G2 o G3, o quítelo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>Write an angle from 0 to 359.999, or IC( ) for a distance.</source>
      <translation>Escriba un ángulo de 0 a 359.999, o IC( ) para una distancia.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>kind of feed</source>
      <translation>clase de avance</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>no feedrate is programmed.</source>
      <translation>no hay avance programado.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>no spindle speed for G95: the spindle stands.</source>
      <translation>no hay velocidad de husillo para G95: el husillo está parado.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>suppression of offsets</source>
      <translation>supresión de desplazamientos</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/linear_moves.py" />
      <source>the feed</source>
      <translation>el avance</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/modes_and_offsets.py" />
      <source>%1: an offset is a plain number.</source>
      <translation>%1: un desplazamiento es un número simple.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/modes_and_offsets.py" />
      <source>Take C out, or choose a machine file that has it.</source>
      <translation>Quite C, o elija un archivo de máquina que lo tenga.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/modes_and_offsets.py" />
      <source>Write %1 with its number.</source>
      <translation>Escriba %1 con su número.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/modes_and_offsets.py" />
      <source>absolute or incremental</source>
      <translation>absoluto o incremental</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/modes_and_offsets.py" />
      <source>settable offset</source>
      <translation>cero ajustable</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/modes_and_offsets.py" />
      <source>unit of length</source>
      <translation>unidad de longitud</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/modes_and_offsets.py" />
      <source>unknown axis: this machine has no third axis.</source>
      <translation>eje desconocido: esta máquina no tiene tercer eje.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>%1 is too small: the ends are %2 mm apart, half of which it takes at least.</source>
      <translation>%1 es demasiado chico: los extremos están a %2 mm, y necesita al menos la mitad.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>%1: an opening angle lies over 0 and under 360.</source>
      <translation>%1: un ángulo de apertura es mayor que 0 y menor que 360.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>AR stands without an end point and without I and K.</source>
      <translation>AR está sin punto final y sin I y K.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>Add one of them.</source>
      <translation>Agregue uno de ellos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>Correct CR or the end point.</source>
      <translation>Corrija CR o el punto final.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>I and K are distances from the start, I a radius; AC( ) makes them coordinates.</source>
      <translation>I y K son distancias desde el inicio, I es radio; AC( ) las vuelve coordenadas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>Keep two of them.</source>
      <translation>Deje dos de ellos.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>arcs of X and Z need G18.</source>
      <translation>los arcos de X y Z necesitan G18.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>the arc by %1 ends where it starts.</source>
      <translation>el arco por %1 termina donde empieza.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>the arc has AR, an end point and a centre.</source>
      <translation>el arco tiene AR, un punto final y un centro.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>the arc has CR and another way to say where its centre is.</source>
      <translation>el arco tiene CR y otra forma de decir dónde está su centro.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>the arc has neither CR, AR nor I and K.</source>
      <translation>el arco no tiene ni CR ni AR ni I y K.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>the arc's radius is %1 mm at its start and %2 mm at its end.</source>
      <translation>el radio del arco es %1 mm al inicio y %2 mm al final.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_arcs.py" />
      <source>the centre of the arc is its start point.</source>
      <translation>el centro del arco es su punto de inicio.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_interpreter.py" />
      <source>%1 is no word, and no variable of this program.</source>
      <translation>%1 no es una palabra ni una variable de este programa.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_interpreter.py" />
      <source>Add the axes.</source>
      <translation>Agregue los ejes.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_interpreter.py" />
      <source>G53 acts in a block that moves an axis.</source>
      <translation>G53 actúa en un bloque que mueve un eje.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_interpreter.py" />
      <source>Look at its loops, and lower the passes of its calls.</source>
      <translation>Mire sus bucles y baje las repeticiones de sus llamadas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_interpreter.py" />
      <source>Write DEF REAL %1 before it.</source>
      <translation>Escriba antes DEF REAL %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_interpreter.py" />
      <source>kind of spindle speed</source>
      <translation>clase de velocidad del husillo</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_interpreter.py" />
      <source>the program makes more than %1 blocks or %2 executed lines.</source>
      <translation>el programa hace más de %1 bloques o %2 líneas ejecutadas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_state.py" />
      <source>%1 has no value: %2.</source>
      <translation>%1 no tiene valor: %2.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_state.py" />
      <source>%1: %2 must be over 0.</source>
      <translation>%1: %2 debe ser mayor que 0.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_state.py" />
      <source>DEF REAL %1</source>
      <translation>DEF REAL %1</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_state.py" />
      <source>Write %1 before it.</source>
      <translation>Escriba antes %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_state.py" />
      <source>no DEF has named it</source>
      <translation>ningún DEF lo ha nombrado</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_state.py" />
      <source>the program has not set it</source>
      <translation>el programa no lo ha fijado</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>%1 and %2 are of one group (%3).</source>
      <translation>%1 y %2 son de un mismo grupo (%3).</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>%1 and %2 stand in one block.</source>
      <translation>%1 y %2 están en un bloque.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>%1 are the most.</source>
      <translation>lo más son %1.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>%1 is no code of this control.</source>
      <translation>%1 no es código de este control.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>%1 is programmed twice in the block.</source>
      <translation>%1 está programado dos veces en el bloque.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>%1 needs a block of its own, with axes and nothing else.</source>
      <translation>%1 necesita su propio bloque, con ejes y nada más.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>%1 stands in a block without X or Z.</source>
      <translation>%1 está en un bloque sin X ni Z.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>DIAMON and DIAMOF are of one group.</source>
      <translation>DIAMON y DIAMOF son de un mismo grupo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>G4 needs a block of its own, with F (seconds) or S (revolutions).</source>
      <translation>G4 necesita su propio bloque, con F (segundos) o S (vueltas).</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>M%1 and M%2 exclude each other.</source>
      <translation>M%1 y M%2 se excluyen.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>One G code of a group per block.</source>
      <translation>Un código G de un grupo por bloque.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>Put it behind a move.</source>
      <translation>Póngalo tras un movimiento.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>Split the block.</source>
      <translation>Divida el bloque.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/sinumerik_statement.py" />
      <source>the block holds %1 M codes.</source>
      <translation>el bloque contiene %1 códigos M.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>%1 is a dwell of %2 s; %3 are the most.</source>
      <translation>%1 es una espera de %2 s; lo más son %3.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>%1 is over the spindle's %2 rpm.</source>
      <translation>%1 pasa de las %2 rpm del husillo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>%1 m/min is no surface speed that a tool can stand.</source>
      <translation>%1 m/min no es velocidad superficial que aguante una herramienta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>%1 needs a controlled spindle, which this machine does not have.</source>
      <translation>%1 necesita un husillo controlado, que esta máquina no tiene.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>%1 starts the spindle and no S has said how fast.</source>
      <translation>%1 arranca el husillo y ninguna S dijo qué tan rápido.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>%1 starts the spindle with the collet open.</source>
      <translation>%1 arranca el husillo con la boquilla abierta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>%1: a dwell is 0 or longer.</source>
      <translation>%1: una espera es 0 o más.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>%1: the speed has no sign; M3 and M4 say the direction.</source>
      <translation>%1: la velocidad no lleva signo; M3 y M4 dicen el sentido.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>Close it.</source>
      <translation>Ciérrela.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>F counts in seconds, S in revolutions.</source>
      <translation>F cuenta en segundos, S en vueltas.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>G4 %1 waits for revolutions of a spindle that stands.</source>
      <translation>G4 %1 espera vueltas de un husillo parado.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>G96 is in force and F counts in mm/min (G94).</source>
      <translation>G96 está vigente y F cuenta en mm/min (G94).</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>G97 makes S rpm.</source>
      <translation>G97 hace de S rpm.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>Start it with M3 or M4, or write G4 F.</source>
      <translation>Arránquelo con M3 o M4, o escriba G4 F.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>Take the sign out.</source>
      <translation>Quite el signo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>Write G95 where F is meant as mm a revolution.</source>
      <translation>Escriba G95 donde F signifique mm por vuelta.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>Write S in the block.</source>
      <translation>Escriba S en el bloque.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/spindle_and_dwell.py" />
      <source>the limit of the speed</source>
      <translation>el tope de la velocidad</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/subprogram_flow.py" />
      <source>M%1 ends a main program, and this is a subprogram.</source>
      <translation>M%1 termina un programa principal, y éste es un subprograma.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/subprogram_flow.py" />
      <source>Put %1.spf beside the main program, or %_N_%2_SPF into its file.</source>
      <translation>Ponga %1.spf junto al programa principal, o %_N_%2_SPF en su archivo.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/subprogram_flow.py" />
      <source>subprograms call each other more than %1 deep.</source>
      <translation>los subprogramas se llaman unos a otros a más de %1 niveles.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/subprogram_flow.py" />
      <source>the subprogram %1 does not exist.</source>
      <translation>el subprograma %1 no existe.</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/third_axis.py" />
      <source>%1 is no position of a modulo axis, which has 0 to &lt;360</source>
      <translation>%1 no es posición de un eje módulo, que tiene de 0 a &lt;360</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/third_axis.py" />
      <source>%1 needs a modulo rotary axis</source>
      <translation>%1 necesita un eje giratorio módulo</translation>
    </message>
    <message>
      <location filename="core/interpreter/sinumerik/third_axis.py" />
      <source>the end point %1 lies beyond -360 to +360 of the machine</source>
      <translation>el punto final %1 está fuera de -360 a +360 de la máquina</translation>
    </message>
    <message>
      <location filename="core/language/diagnostics.py" />
      <source>%1 (%2 times)</source>
      <translation>%1 (%2 veces)</translation>
    </message>
    <message>
      <location filename="core/language/formulas.py" />
      <source>A closing bracket is missing</source>
      <translation>Falta un paréntesis de cierre</translation>
    </message>
    <message>
      <location filename="core/language/formulas.py" />
      <source>Complete it.</source>
      <translation>Complétela.</translation>
    </message>
    <message>
      <location filename="core/language/formulas.py" />
      <source>Split it.</source>
      <translation>Divídala.</translation>
    </message>
    <message>
      <location filename="core/language/formulas.py" />
      <source>The formula is nested too deep</source>
      <translation>La fórmula está anidada demasiado</translation>
    </message>
    <message>
      <location filename="core/language/formulas.py" />
      <source>The formula needs a number or a parameter</source>
      <translation>La fórmula necesita un número o un parámetro</translation>
    </message>
    <message>
      <location filename="core/language/formulas.py" />
      <source>Write ) behind the formula.</source>
      <translation>Escriba ) tras la fórmula.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>%1 PGM</source>
      <translation>%1 PGM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>BLK FORM 0.%1</source>
      <translation>BLK FORM 0.%1</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>CALL LBL</source>
      <translation>CALL LBL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>CYCL DEF 7.%1</source>
      <translation>CYCL DEF 7.%1</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>LBL %1</source>
      <translation>LBL %1</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>MB MAX</source>
      <translation>MB MAX</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>REP %1</source>
      <translation>REP %1</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>TOOL CALL</source>
      <translation>TOOL CALL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>TRANS DATUM AXIS</source>
      <translation>TRANS DATUM AXIS</translation>
    </message>
    <message>
      <location filename="core/language/klartext/canonical_text.py" />
      <source>TRANS DATUM RESET</source>
      <translation>TRANS DATUM RESET</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>A cycle takes Q parameters</source>
      <translation>Un ciclo toma parámetros Q</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>A rotation needs ROT and its angle</source>
      <translation>Un giro necesita ROT y su ángulo</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>CYCL CALL PAT needs a table of points.</source>
      <translation>CYCL CALL PAT necesita una tabla de puntos.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>CYCL DEF %1 needs its line</source>
      <translation>CYCL DEF %1 necesita su línea</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>CYCL DEF 7.%1 takes X, Y or Z</source>
      <translation>CYCL DEF 7.%1 toma X, Y o Z</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>CYCL DEF needs the number of a cycle</source>
      <translation>CYCL DEF necesita el número de un ciclo</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>Mirroring takes X, Y and Z</source>
      <translation>La simetría toma X, Y y Z</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>No word of a rotation</source>
      <translation>No es palabra de un giro</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>No word of cycle %1</source>
      <translation>No es palabra del ciclo %1</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>No word of cycle 7</source>
      <translation>No es palabra del ciclo 7</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>No word of scaling</source>
      <translation>No es palabra de escala</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>Scaling needs SCL and its factor</source>
      <translation>La escala necesita SCL y su factor</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>Write CYCL DEF %1.0.</source>
      <translation>Escriba CYCL DEF %1.0.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>Write Q200=+2 and so on.</source>
      <translation>Escriba Q200=+2, etc.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/cycle_blocks.py" />
      <source>Write the points with M99.</source>
      <translation>Escriba los puntos con M99.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>%1 is not supported here.</source>
      <translation>Aquí no se admite %1.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Arithmetical error</source>
      <translation>Error aritmético</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>CC missing</source>
      <translation>Falta CC</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Circle end point incorrect</source>
      <translation>Punto final del círculo incorrecto</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Contradictory entry</source>
      <translation>Entrada contradictoria</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Cycle incomplete</source>
      <translation>Ciclo incompleto</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Direction of rotation not defined</source>
      <translation>Sentido de giro no definido</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Entered angle not permitted</source>
      <translation>Ángulo introducido no permitido</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Error of the program</source>
      <translation>Error del programa</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Excessive nesting</source>
      <translation>Demasiados niveles</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Feed rate is missing</source>
      <translation>Falta el avance</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Input value incorrect</source>
      <translation>Valor introducido incorrecto</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Label defined twice</source>
      <translation>Etiqueta definida dos veces</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Label not found</source>
      <translation>Etiqueta no encontrada</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Not permitted with M128</source>
      <translation>No permitido con M128</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Not supported</source>
      <translation>No se admite</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>PLANE not permitted with M128</source>
      <translation>PLANE no permitido con M128</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Path function not possible here</source>
      <translation>Función de trayectoria imposible aquí</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Plane wrongly defined</source>
      <translation>Plano mal definido</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Program it with L moves and PLANE, or run the program on a control that has it.</source>
      <translation>Prográmelo con movimientos L y PLANE, o corra el programa en un control que lo tenga.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Program not found</source>
      <translation>Programa no encontrado</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Q parameter not defined</source>
      <translation>Parámetro Q sin definir</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Radius compensation not permitted here</source>
      <translation>Corrección de radio no permitida aquí</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Rounding not possible</source>
      <translation>Redondeo imposible</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Syntax error</source>
      <translation>Error de sintaxis</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Tool axis is missing</source>
      <translation>Falta el eje de herramienta</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Tool not defined</source>
      <translation>Herramienta no definida</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Tool radius too large</source>
      <translation>Radio de herramienta demasiado grande</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Wrong axis programmed</source>
      <translation>Eje mal programado</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_faults.py" />
      <source>Wrong rpm</source>
      <translation>RPM incorrectas</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>'%1' begins no block.</source>
      <translation>'%1' no empieza ningún bloque.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>A block begins with L, PLANE, TOOL CALL, LBL or the like.</source>
      <translation>Un bloque empieza con L, PLANE, TOOL CALL, LBL o similar.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>BLK FORM</source>
      <translation>BLK FORM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>Break it into lines.</source>
      <translation>Divídala en líneas.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>CALL PGM</source>
      <translation>CALL PGM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>CALL SELECTED</source>
      <translation>CALL SELECTED</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>CONTOUR DEF</source>
      <translation>CONTOUR DEF</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>CYCL DEF</source>
      <translation>CYCL DEF</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>END PGM</source>
      <translation>END PGM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>PATTERN DEF</source>
      <translation>PATTERN DEF</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>SEL CONTOUR</source>
      <translation>SEL CONTOUR</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>SEL PATTERN</source>
      <translation>SEL PATTERN</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>SEL PGM</source>
      <translation>SEL PGM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>SEL TABLE</source>
      <translation>SEL TABLE</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>TCH PROBE</source>
      <translation>TCH PROBE</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>TOOL DEF</source>
      <translation>TOOL DEF</translation>
    </message>
    <message>
      <location filename="core/language/klartext/klartext_line.py" />
      <source>The line has %1 characters.</source>
      <translation>La línea tiene %1 caracteres.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>%1 A comment begins with ;.</source>
      <translation>%1 Un comentario empieza con ;.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>%1 goes up to %2.</source>
      <translation>%1 llega hasta %2.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>%1 has an empty name.</source>
      <translation>%1 tiene un nombre vacío.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>%1 has no number</source>
      <translation>%1 no tiene número</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>%1 has no value</source>
      <translation>%1 no tiene valor</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>%1 needs a whole number</source>
      <translation>%1 necesita un número entero</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>%1 stands twice in the block.</source>
      <translation>%1 está dos veces en el bloque.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>; '%1' stands here</source>
      <translation>; aquí está '%1'</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>; the line ends here</source>
      <translation>; la línea termina aquí</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>Correct the number.</source>
      <translation>Corrija el número.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>F has no value</source>
      <translation>F no tiene valor</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>Q parameters go up to Q%1.</source>
      <translation>Los parámetros Q llegan hasta Q%1.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>Take another parameter.</source>
      <translation>Use otro parámetro.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>Write a number such as +10, or a Q parameter.</source>
      <translation>Escriba un número como +10, o un parámetro Q.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>Write a number, Q, MAX or AUTO behind F.</source>
      <translation>Escriba un número, Q, MAX o AUTO tras F.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>Write a number.</source>
      <translation>Escriba un número.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/line_cursor.py" />
      <source>Write the name.</source>
      <translation>Escriba el nombre.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>%1 needs %2</source>
      <translation>%1 necesita %2</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>%1 takes its size and a feed</source>
      <translation>%1 toma su tamaño y un avance</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>%1 takes no DR.</source>
      <translation>%1 no toma DR.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>APPR CT</source>
      <translation>APPR CT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>APPR LCT</source>
      <translation>APPR LCT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>APPR LN</source>
      <translation>APPR LN</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>APPR LT</source>
      <translation>APPR LT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>APPR PCT</source>
      <translation>APPR PCT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>APPR PLCT</source>
      <translation>APPR PLCT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>APPR PLN</source>
      <translation>APPR PLN</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>APPR PLT</source>
      <translation>APPR PLT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>An M function was expected</source>
      <translation>Se esperaba una función M</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>CC takes two axes</source>
      <translation>CC toma dos ejes</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>DEP CT</source>
      <translation>DEP CT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>DEP LCT</source>
      <translation>DEP LCT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>DEP LN</source>
      <translation>DEP LN</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>DEP LT</source>
      <translation>DEP LT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>DEP PLCT</source>
      <translation>DEP PLCT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>It takes %1, R0, RL or RR, a feed and M functions.</source>
      <translation>Toma %1, R0, RL o RR, un avance y funciones M.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>M128 takes a feed in numbers, or FMAX.</source>
      <translation>M128 toma un avance en números, o FMAX.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>M140 needs MB</source>
      <translation>M140 necesita MB</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>No word of %1 %2 block</source>
      <translation>No es palabra de %1 bloque %2</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>The axis has no value</source>
      <translation>El eje no tiene valor</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>There are more than %1 M functions in the block.</source>
      <translation>Hay más de %1 funciones M en el bloque.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>Write F and a number.</source>
      <translation>Escriba F y un número.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>Write MB and a length, or MB MAX.</source>
      <translation>Escriba MB y una longitud, o MB MAX.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/path_block.py" />
      <source>Write a number such as +10.</source>
      <translation>Escriba un número como +10.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>%1 %2 missing</source>
      <translation>%1: falta %2</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>%1 ROT</source>
      <translation>%1 ROT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>%1 stands behind %2.</source>
      <translation>%1 está tras %2.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>All of them are needed, zeros too.</source>
      <translation>Se necesitan todos, también los ceros.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>COORD ROT or TABLE ROT</source>
      <translation>COORD ROT o TABLE ROT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>DIST belongs to MOVE, not to %1.</source>
      <translation>DIST pertenece a MOVE, no a %1.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>MOVE, TURN or STAY is missing</source>
      <translation>Falta MOVE, TURN o STAY</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>No word of a PLANE block</source>
      <translation>No es palabra de un bloque PLANE</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>PLANE AXIAL needs an axis angle</source>
      <translation>PLANE AXIAL necesita un ángulo de eje</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>PLANE RELATIV takes one of SPA, SPB and SPC.</source>
      <translation>PLANE RELATIV lleva uno de SPA, SPB y SPC.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>PLANE needs %1 or %2</source>
      <translation>PLANE necesita %1 o %2</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>STAY moves nothing: no %1 here.</source>
      <translation>STAY no mueve nada: aquí no va %1.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>SYM or SEQ</source>
      <translation>SYM o SEQ</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>Say how the rotary axes are positioned.</source>
      <translation>Diga cómo se posicionan los ejes giratorios.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>Take one of them out.</source>
      <translation>Quite uno de ellos.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>Write A, B or C with its angle.</source>
      <translation>Escriba A, B o C con su ángulo.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/plane_block.py" />
      <source>Write one angle.</source>
      <translation>Escriba un ángulo.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>%1 for %2</source>
      <translation>%1 para %2</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>%1 parameters go up to %2%3.</source>
      <translation>Los parámetros %1 llegan hasta %2%3.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>'=' was expected behind %1%2</source>
      <translation>Se esperaba '=' tras %1%2</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>A Q parameter was expected</source>
      <translation>Se esperaba un parámetro Q</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>An operator was expected</source>
      <translation>Se esperaba un operador</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>FN %1 has more than it takes</source>
      <translation>FN %1 tiene más de lo que toma</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>FN %1 needs %2</source>
      <translation>FN %1 necesita %2</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>FN %1 needs GOTO LBL</source>
      <translation>FN %1 necesita GOTO LBL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>FN %1 needs IF</source>
      <translation>FN %1 necesita IF</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>FN 14 needs ERROR =</source>
      <translation>FN 14 necesita ERROR =</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>FN 18 needs ID and NR</source>
      <translation>FN 18 necesita ID y NR</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>FN 18 needs SYSREAD</source>
      <translation>FN 18 necesita SYSREAD</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>GOTO LBL</source>
      <translation>GOTO LBL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>No word of FN 18</source>
      <translation>No es palabra de FN 18</translation>
    </message>
    <message>
      <location filename="core/language/klartext/q_parameters.py" />
      <source>No word of a jump</source>
      <translation>No es palabra de un salto</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>%1 is missing</source>
      <translation>Falta %1</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>%1 needs MM or INCH.</source>
      <translation>%1 necesita MM o INCH.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>A corner needs X, Y and Z.</source>
      <translation>Una esquina necesita X, Y y Z.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>AXIS POS</source>
      <translation>AXIS POS</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>AXIS SPAT</source>
      <translation>AXIS SPAT</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>BLK FORM %1</source>
      <translation>BLK FORM %1</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>BLK FORM 0.1 needs the tool axis</source>
      <translation>BLK FORM 0.1 necesita el eje de herramienta</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>CALL PGM needs the name of a program</source>
      <translation>CALL PGM necesita el nombre de un programa</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>Call another label.</source>
      <translation>Llame otra etiqueta.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>FUNCTION %1</source>
      <translation>FUNCTION %1</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>FUNCTION MODE MILL</source>
      <translation>FUNCTION MODE MILL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>FUNCTION TCPM with AXIS SPAT or PATHCTRL VECTOR</source>
      <translation>FUNCTION TCPM con AXIS SPAT o PATHCTRL VECTOR</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>It takes F TCP, AXIS POS, PATHCTRL AXIS.</source>
      <translation>Toma F TCP, AXIS POS, PATHCTRL AXIS.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>It takes a tool, L and R.</source>
      <translation>Toma una herramienta, L y R.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>It takes a tool, its axis, S, F, DL, DR and DR2.</source>
      <translation>Toma una herramienta, su eje, S, F, DL, DR y DR2.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>LBL 0 ends a subprogram; it cannot be called.</source>
      <translation>LBL 0 termina un subprograma; no se puede llamar.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>MODE MILL</source>
      <translation>MODE MILL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>No word of BLK FORM</source>
      <translation>No es palabra de BLK FORM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>No word of CALL LBL</source>
      <translation>No es palabra de CALL LBL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>No word of FUNCTION TCPM</source>
      <translation>No es palabra de FUNCTION TCPM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>No word of LBL</source>
      <translation>No es palabra de LBL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>No word of TOOL CALL</source>
      <translation>No es palabra de TOOL CALL</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>No word of TOOL DEF</source>
      <translation>No es palabra de TOOL DEF</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>No word of TRANS DATUM</source>
      <translation>No es palabra de TRANS DATUM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>PATHCTRL AXIS</source>
      <translation>PATHCTRL AXIS</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>PATHCTRL VECTOR</source>
      <translation>PATHCTRL VECTOR</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>RESET TCPM</source>
      <translation>RESET TCPM</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>TRANS DATUM AXIS needs X, Y or Z</source>
      <translation>TRANS DATUM AXIS necesita X, Y o Z</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>TRANS DATUM TABLE</source>
      <translation>TRANS DATUM TABLE</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>TRANS DATUM needs AXIS or RESET</source>
      <translation>TRANS DATUM necesita AXIS o RESET</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>TRANS MIRROR needs AXIS or RESET</source>
      <translation>TRANS MIRROR necesita AXIS o RESET</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>TRANS needs DATUM, MIRROR, ROTATION or SCALE</source>
      <translation>TRANS necesita DATUM, MIRROR, ROTATION o SCALE</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>Write Z behind 0.1.</source>
      <translation>Escriba Z tras 0.1.</translation>
    </message>
    <message>
      <location filename="core/language/klartext/structure_blocks.py" />
      <source>Write the unit behind the name.</source>
      <translation>Escriba la unidad tras el nombre.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>%1 numbers a program elsewhere; here the file has a name.</source>
      <translation>%1 numera un programa en otros controles; aquí el archivo tiene nombre.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>%1: T%2 takes tool %3 with its offset here%4.</source>
      <translation>%1: aquí T%2 toma la herramienta %3 con su compensación%4.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>, and a second offset is D%1</source>
      <translation>, y una segunda compensación es D%1</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>A feed is F here, and the lead of a thread K.</source>
      <translation>Aquí un avance es F, y el paso de una rosca K.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>A line of % stands round a program that is transferred, not in it.</source>
      <translation>Una línea de % va alrededor de un programa que se transfiere, no dentro de él.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>A stop is M00 here.</source>
      <translation>Un paro es aquí M00.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>A subroutine ends with M99 here.</source>
      <translation>Una subrutina termina aquí con M99.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>A thread is G33 here, with all its passes.</source>
      <translation>Una rosca es aquí G33, con todas sus pasadas.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Boring is written out here.</source>
      <translation>El mandrinado se escribe aquí movimiento por movimiento.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Coolant is M08 here.</source>
      <translation>El refrigerante es aquí M08.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Cycles act on their own line here, and nothing has to end them.</source>
      <translation>Aquí los ciclos actúan en su propia línea, y nada tiene que terminarlos.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Drilling is G81 here, in pecks G83, and a dwell is G04.</source>
      <translation>Barrenar es aquí G81, con picoteo G83, y una pausa G04.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Feed per minute is G94 here.</source>
      <translation>El avance por minuto es aquí G94.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Feed per revolution is G95 here.</source>
      <translation>El avance por vuelta es aquí G95.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>High-speed modes have no code here.</source>
      <translation>Los modos de alta velocidad no tienen código aquí.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Inch is G70 here.</source>
      <translation>La pulgada es aquí G70.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Incremental moves are X and Z under G91 here.</source>
      <translation>Los movimientos incrementales son aquí X y Z con G91.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Machine coordinates are those of T0 here.</source>
      <translation>Las coordenadas de máquina son aquí las de T0.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Metric is G71 here.</source>
      <translation>El métrico es aquí G71.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Milling of the face ends with (END) here.</source>
      <translation>El fresado de la cara termina aquí con (END).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Milling of the face is (~PLXC) here.</source>
      <translation>El fresado de la cara es aquí (~PLXC).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Milling round the part is (~PLZC) here.</source>
      <translation>El fresado alrededor de la pieza es aquí (~PLZC).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Move to a clear X and Z.</source>
      <translation>Vaya a una X y una Z libres.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Part zero is in the tool's offset here, and a work shift is G10.</source>
      <translation>El cero de pieza está aquí en la compensación de la herramienta, y un desplazamiento es G10.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Put a comment in parentheses.</source>
      <translation>Ponga el comentario entre paréntesis.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Q is a word of other controls' cycles; here they are G33, G74, G75, G81 and G83.</source>
      <translation>Q es una palabra de los ciclos de otros controles; aquí son G33, G74, G75, G81 y G83.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>See the language page.</source>
      <translation>Vea la página del lenguaje.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>T alone changes the tool here.</source>
      <translation>Aquí T sola cambia la herramienta.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>T0 takes the tool's offset away here.</source>
      <translation>Aquí T0 quita la compensación de la herramienta.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Take M06 out.</source>
      <translation>Quite M06.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Tapping is written out here: G95, in, M04, out.</source>
      <translation>El machueleado se escribe aquí entero: G95, entrar, M04, salir.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>The highest speed under G96 is G77Sn here, and a preset of the position G92.</source>
      <translation>La velocidad máxima con G96 es aquí G77Sn, y preajustar la posición es G92.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>The offset of a tool is T here, and a second one D.</source>
      <translation>La compensación de una herramienta es aquí T, y una segunda D.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>The offset of a tool is T here.</source>
      <translation>La compensación de una herramienta es aquí T.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>The plane is always that of X and Z here.</source>
      <translation>El plano es aquí siempre el de X y Z.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>The way of going round corners has no code here.</source>
      <translation>La forma de pasar las esquinas no tiene código aquí.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>There are no macros here; a subroutine is M98Pn.</source>
      <translation>Aquí no hay macros; una subrutina es M98Pn.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>There is no reference point to move to here.</source>
      <translation>Aquí no hay punto de referencia al que ir.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Type a point.</source>
      <translation>Escriba un punto.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write (END).</source>
      <translation>Escriba (END).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write (~PLXC) … (END).</source>
      <translation>Escriba (~PLXC) … (END).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write (~PLZC) … (END).</source>
      <translation>Escriba (~PLZC) … (END).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write F or K.</source>
      <translation>Escriba F o K.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write G33XnZnInKn.</source>
      <translation>Escriba G33XnZnInKn.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write G77Sn or G92.</source>
      <translation>Escriba G77Sn o G92.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write G81 or G83.</source>
      <translation>Escriba G81 o G83.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write G91 and X.</source>
      <translation>Escriba G91 y X.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write G91 and Z.</source>
      <translation>Escriba G91 y Z.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write M98Pn.</source>
      <translation>Escriba M98Pn.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write T and the tool's number.</source>
      <translation>Escriba T y el número de la herramienta.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write T or D.</source>
      <translation>Escriba T o D.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write T%1.</source>
      <translation>Escriba T%1.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write T, or G10XnZn before it.</source>
      <translation>Escriba T, o antes G10XnZn.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write T0 before the move.</source>
      <translation>Escriba T0 antes del movimiento.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write the moves.</source>
      <translation>Escriba los movimientos.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>Write the number.</source>
      <translation>Escriba el número.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>a comma, and there are none here</source>
      <translation>una coma, y aquí no las hay</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>a variable of other controls, and there are none here</source>
      <translation>una variable de otros controles, y aquí no las hay</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>a word of other controls</source>
      <translation>una palabra de otros controles</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>how a comment or a line's end is written elsewhere</source>
      <translation>como se escribe en otros controles un comentario o el final de una línea</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>how other controls calculate, and this one does not</source>
      <translation>como calculan otros controles, y éste no</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>how other controls number programs; here the file has a name</source>
      <translation>como numeran programas otros controles; aquí el archivo tiene nombre</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/other_controls.py" />
      <source>what a transfer puts round a program, and no line of it</source>
      <translation>lo que una transferencia pone alrededor de un programa, y no es línea suya</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>%1 belongs to an arc, and neither G02 nor G03 is on the line.</source>
      <translation>%1 pertenece a un arco, y ni G02 ni G03 está en la línea.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>%1 is missing: I and J are the coordinates of the arc's centre.</source>
      <translation>Falta %1: I y J son las coordenadas del centro del arco.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>%1 is no word of plane switching.</source>
      <translation>%1 no es palabra del cambio de plano.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>%1 is out of range.</source>
      <translation>%1 está fuera de rango.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>%1 stands with other words.</source>
      <translation>%1 va con otras palabras.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>%1: of the G codes only G02 and G03 may stand in a plane.</source>
      <translation>%1: de los códigos G sólo G02 y G03 pueden estar en un plano.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>'%1' is no word of plane switching.</source>
      <translation>'%1' no es palabra del cambio de plano.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>An arc of a plane moves X and Y alone.</source>
      <translation>Un arco de un plano mueve sólo X y Y.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>Between the entry and (END) stand only (X Y Z F), (G02 or G03 X Y I J), (H) and (D).</source>
      <translation>Entre la entrada y (END) sólo van (X Y Z F), (G02 o G03 X Y I J), (H) y (D).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>G02 and G03 are one shot.</source>
      <translation>G02 y G03 valen una sola vez.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>Look for a lost point.</source>
      <translation>Busque un punto perdido.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>Move Z on another line.</source>
      <translation>Mueva Z en otra línea.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>The line holds %1 twice.</source>
      <translation>La línea contiene %1 dos veces.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>The statement is empty.</source>
      <translation>La instrucción está vacía.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>This line is no statement in parentheses.</source>
      <translation>Esta línea no es una instrucción entre paréntesis.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/plane_switching_lines.py" />
      <source>Write (%1n) alone.</source>
      <translation>Escriba sólo (%1n).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 has a decimal point and no digit.</source>
      <translation>%1 tiene punto decimal y ninguna cifra.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 has a sign and no number.</source>
      <translation>%1 tiene signo y ningún número.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 has no number.</source>
      <translation>%1 no tiene número.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 has over %2 digits.</source>
      <translation>%1 tiene más de %2 cifras.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 is no word of the language.</source>
      <translation>%1 no es palabra del lenguaje.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 is no word of the language. %2</source>
      <translation>%1 no es una palabra del lenguaje. %2</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 is out of range: %2 goes from %3 to %4.</source>
      <translation>%1 está fuera de rango: %2 va de %3 a %4.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 is out of range: a loop runs %2 to %3 times.</source>
      <translation>%1 está fuera de rango: un lazo corre de %2 a %3 veces.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 must be a whole number without a sign.</source>
      <translation>%1 debe ser un número entero sin signo.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1 takes no number.</source>
      <translation>%1 no lleva número.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1: %2 takes exactly two digits.</source>
      <translation>%1: %2 lleva exactamente dos cifras.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1: a feed of 0 moves nothing; a rapid is G00 here.</source>
      <translation>%1: un avance de 0 no mueve nada; un rápido es aquí G00.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1: offsets go from 1 to 32.</source>
      <translation>%1: las compensaciones van de 1 a 32.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>%1: tools go from 1 to 32.</source>
      <translation>%1: las herramientas van de 1 a 32.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>'%1' is no part of the language.</source>
      <translation>'%1' no es parte del lenguaje.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>'%1' is text outside parentheses.</source>
      <translation>'%1' es texto fuera de paréntesis.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>')' closes no comment.</source>
      <translation>')' no cierra ningún comentario.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>'/' may only stand first on a line.</source>
      <translation>'/' sólo puede ir primero en una línea.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>A comma is not allowed anywhere.</source>
      <translation>La coma no se permite en ninguna parte.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>A number stands without a letter.</source>
      <translation>Hay un número sin letra.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>A sign stands inside a number.</source>
      <translation>Hay un signo dentro de un número.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Add '(' or take it out.</source>
      <translation>Agregue '(' o quítelo.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Comments go in parentheses.</source>
      <translation>Los comentarios van entre paréntesis.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Correct the count.</source>
      <translation>Corrija la cuenta.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>D0 cancels.</source>
      <translation>D0 cancela.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Lines have no numbers here: N is not allowed.</source>
      <translation>Aquí las líneas no llevan número: N no se permite.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Look the word up in the language page.</source>
      <translation>Busque la palabra en la página del lenguaje.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Move it to the front.</source>
      <translation>Muévalo al principio.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Numbers have no exponent here.</source>
      <translation>Aquí los números no llevan exponente.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Round it.</source>
      <translation>Redondéelo.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Split it into two words.</source>
      <translation>Divídalo en dos palabras.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>T0 cancels the tool.</source>
      <translation>T0 cancela la herramienta.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Take the N word out.</source>
      <translation>Quite la palabra N.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>The comment has no closing parenthesis.</source>
      <translation>El comentario no tiene paréntesis de cierre.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>The letter O stands where a zero belongs.</source>
      <translation>Hay una letra O donde va un cero.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>The number has two decimal points.</source>
      <translation>El número tiene dos puntos decimales.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write %1%2.</source>
      <translation>Escriba %1%2.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write (%1).</source>
      <translation>Escriba (%1).</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write a decimal point.</source>
      <translation>Escriba un punto decimal.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write it after %1.</source>
      <translation>Escríbalo después de %1.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write its letter.</source>
      <translation>Escriba su letra.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write the digits.</source>
      <translation>Escriba las cifras.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write the feed.</source>
      <translation>Escriba el avance.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write the number after it.</source>
      <translation>Escriba después el número.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write the number out; a feed is F.</source>
      <translation>Escriba el número completo; un avance es F.</translation>
    </message>
    <message>
      <location filename="core/language/omniturn/word_faults.py" />
      <source>Write two digits.</source>
      <translation>Escriba dos cifras.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>A jump needs a label</source>
      <translation>Un salto necesita una etiqueta</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>DEF needs REAL, INT or BOOL</source>
      <translation>DEF necesita REAL, INT o BOOL</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>DEF needs the name of a variable</source>
      <translation>DEF necesita el nombre de una variable</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>FOR needs TO</source>
      <translation>FOR necesita TO</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>FOR needs a variable and =</source>
      <translation>FOR necesita una variable y =</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>MSG needs its text in brackets and quotes</source>
      <translation>MSG necesita su texto entre paréntesis y comillas</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>More stands behind %1</source>
      <translation>Hay más tras %1</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>Other types are not read here.</source>
      <translation>Otros tipos no se leen aquí.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>Put it into a block of its own.</source>
      <translation>Póngalo en un bloque propio.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>Write DEF REAL NAME = 0.</source>
      <translation>Escriba DEF REAL NAME = 0.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>Write FOR R1 = 1 TO 5.</source>
      <translation>Escriba FOR R1 = 1 TO 5.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>Write MSG("TEXT").</source>
      <translation>Escriba MSG("TEXT").</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/program_jumps.py" />
      <source>Write the label, or N with its number.</source>
      <translation>Escriba la etiqueta, o N con su número.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_alarms.py" />
      <source>%1 axis %2</source>
      <translation>%1 eje %2</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_alarms.py" />
      <source>Alarm %1: %2: %3</source>
      <translation>Alarma %1: %2: %3</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_alarms.py" />
      <source>channel %1 block %2</source>
      <translation>canal %1 bloque %2</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_colours.py" />
      <source>in line</source>
      <translation>en la línea</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 are the most; split it.</source>
      <translation>lo más son %1; divídalo.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 has no value in its brackets: %2</source>
      <translation>%1 no tiene valor entre sus paréntesis: %2</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 is no code</source>
      <translation>%1 no es un código</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 is no word</source>
      <translation>%1 no es una palabra</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 is nothing that %2= takes</source>
      <translation>%1 no es nada que %2= acepte</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 is out of range</source>
      <translation>%1 está fuera de rango</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 lacks its =</source>
      <translation>a %1 le falta su =</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 lacks its brackets</source>
      <translation>a %1 le faltan sus paréntesis</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 lies between %2 and %3.</source>
      <translation>%1 está entre %2 y %3.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1 stands behind %2</source>
      <translation>%1 está tras %2</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1%2 is no number</source>
      <translation>%1%2 no es un número</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>%1= has no value: %2</source>
      <translation>%1= no tiene valor: %2</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>A call stands alone.</source>
      <translation>Una llamada va sola.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>A comment begins with ;, and a subprogram's name stands alone.</source>
      <translation>Un comentario empieza con ;, y el nombre de un subprograma va solo.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>Codes are whole numbers of up to four digits.</source>
      <translation>Los códigos son números enteros de hasta cuatro cifras.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>It takes %1.</source>
      <translation>Acepta %1.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>P%1 is no number of passes</source>
      <translation>P%1 no es un número de repeticiones</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>R parameters are R0 to R%1</source>
      <translation>Los parámetros R son de R0 a R%1</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>R%1 is no parameter</source>
      <translation>R%1 no es un parámetro</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>They are R0 to R%1.</source>
      <translation>Son de R0 a R%1.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>Write %1 with a number, or %2=…</source>
      <translation>Escriba %1 con un número, o %2=…</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>Write %1=%2(…).</source>
      <translation>Escriba %1=%2(…).</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>Write %1=…</source>
      <translation>Escriba %1=…</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>Write P1 to P%1.</source>
      <translation>Escriba de P1 a P%1.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>Write it at the start.</source>
      <translation>Escríbalo al principio.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>a number or a formula</source>
      <translation>un número o una fórmula</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>in line %1</source>
      <translation>en la línea %1</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>more stands behind %1</source>
      <translation>hay más tras %1</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>syntax error: %1.</source>
      <translation>error de sintaxis: %1.</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>the block has %1 characters</source>
      <translation>el bloque tiene %1 caracteres</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>the block number does not stand first</source>
      <translation>el número de bloque no va primero</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>the bracket of %1 is not closed</source>
      <translation>el paréntesis de %1 no está cerrado</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>this control does not execute it</source>
      <translation>este control no lo ejecuta</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_lexer.py" />
      <source>this control has no such word</source>
      <translation>este control no tiene esa palabra</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>H functions are not part of this control's SINUMERIK subset</source>
      <translation>las funciones H no son parte del SINUMERIK de este control</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>L is a subprogram only as L with a whole number</source>
      <translation>L es subprograma sólo como L con un número entero</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>P stands only behind the name of a subprogram</source>
      <translation>P va sólo tras el nombre de un subprograma</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>an R parameter stands behind = or is set with =, such as R1=10</source>
      <translation>un parámetro R va tras = o se pone con =, como R1=10</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>an arc in G18 has I and K</source>
      <translation>un arco en G18 tiene I y K</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>incremental words are written with IC( ), such as X=IC(1)</source>
      <translation>las palabras incrementales se escriben con IC( ), como X=IC(1)</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>incremental words are written with IC( ), such as Z=IC(1)</source>
      <translation>las palabras incrementales se escriben con IC( ), como Z=IC(1)</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>this lathe has no axis A</source>
      <translation>este torno no tiene eje A</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>this lathe has no axis B</source>
      <translation>este torno no tiene eje B</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>this lathe has no axis Y</source>
      <translation>este torno no tiene eje Y</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>tool offsets are not part of this control's SINUMERIK subset; use G54 to G59</source>
      <translation>las compensaciones de herramienta no son parte del SINUMERIK de este control; use G54 a G59</translation>
    </message>
    <message>
      <location filename="core/language/sinumerik/sinumerik_words.py" />
      <source>tools are not part of this control's SINUMERIK subset; put the offset into G54 to G59</source>
      <translation>las herramientas no son parte del SINUMERIK de este control; ponga el desplazamiento en G54 a G59</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>%1 cannot be read: %2.</source>
      <translation>no se puede leer %1: %2.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>%1 holds zero bytes: it is no program text.</source>
      <translation>%1 contiene bytes cero: no es texto de programa.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>%1 is empty.</source>
      <translation>%1 está vacío.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>%1 is over 64 MB.</source>
      <translation>%1 pasa de 64 MB.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>%1 is stored as UTF-16.</source>
      <translation>%1 está guardado como UTF-16.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>Choose a file that holds a program.</source>
      <translation>Elija un archivo que contenga un programa.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>Choose a program file with line ends.</source>
      <translation>Elija un archivo de programa con finales de línea.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>Choose a text file.</source>
      <translation>Elija un archivo de texto.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>Line %1 of %2 has %3 characters; %4 are the most.</source>
      <translation>La línea %1 de %2 tiene %3 caracteres; lo más son %4.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>Look at the name and the disk.</source>
      <translation>Vea el nombre y el disco.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>Save it as UTF-8 or plain text.</source>
      <translation>Guárdelo como UTF-8 o texto simple.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>Split the program.</source>
      <translation>Divida el programa.</translation>
    </message>
    <message>
      <location filename="core/language/source.py" />
      <source>reading failed</source>
      <translation>falló la lectura</translation>
    </message>
    <message>
      <location filename="core/language/typography.py" />
      <source>a quotation mark, and there are none here</source>
      <translation>unas comillas, y aquí no las hay</translation>
    </message>
    <message>
      <location filename="core/language/typography.py" />
      <source>a sign that nobody sees</source>
      <translation>un signo que nadie ve</translation>
    </message>
    <message>
      <location filename="core/language/typography.py" />
      <source>no decimal point of the keyboard</source>
      <translation>un punto decimal que no es el del teclado</translation>
    </message>
    <message>
      <location filename="core/language/typography.py" />
      <source>no minus sign of the keyboard</source>
      <translation>un signo menos que no es el del teclado</translation>
    </message>
    <message>
      <location filename="core/language/typography.py" />
      <source>no parenthesis of the keyboard</source>
      <translation>un paréntesis que no es el del teclado</translation>
    </message>
    <message>
      <location filename="core/language/typography.py" />
      <source>no plus sign of the keyboard</source>
      <translation>un signo más que no es el del teclado</translation>
    </message>
    <message>
      <location filename="core/motion/axis_limits.py" />
      <source>%1 of axis %2</source>
      <translation>%1 del eje %2</translation>
    </message>
    <message>
      <location filename="core/motion/axis_limits.py" />
      <source>Motion limit %1 is %2; give a positive number in the machine file.</source>
      <translation>El límite de movimiento %1 es %2; dé un número positivo en el archivo de máquina.</translation>
    </message>
    <message>
      <location filename="core/motion/axis_limits.py" />
      <source>The step of the slides is %1 mm; give a positive number, or 0.</source>
      <translation>El paso de los carros es %1 mm; dé un número positivo, o 0.</translation>
    </message>
    <message>
      <location filename="core/motion/block_table.py" />
      <source>Block %1 tells of all axes, another behind it does not.</source>
      <translation>El bloque %1 habla de todos los ejes, otro después de él no.</translation>
    </message>
    <message>
      <location filename="core/motion/block_table.py" />
      <source>Block %1: %2 is not a number; correct the block.</source>
      <translation>Bloque %1: %2 no es un número; corrija el bloque.</translation>
    </message>
    <message>
      <location filename="core/motion/block_table.py" />
      <source>Block %1: a %2 block has no time law of its own.</source>
      <translation>Bloque %1: un bloque %2 no tiene ley de tiempo propia.</translation>
    </message>
    <message>
      <location filename="core/motion/block_table.py" />
      <source>Block %1: css is %2 mm/s; program a surface speed with S.</source>
      <translation>Bloque %1: css es %2 mm/s; programe una velocidad superficial con S.</translation>
    </message>
    <message>
      <location filename="core/motion/curved_axes.py" />
      <source>Block %1: the slide needs %2 degrees of C; it turns %3.</source>
      <translation>Bloque %1: el carro necesita %2 grados de C; gira %3.</translation>
    </message>
    <message>
      <location filename="core/motion/feed_rates.py" />
      <source>Block %1: %2.</source>
      <translation>Bloque %1: %2.</translation>
    </message>
    <message>
      <location filename="core/motion/feed_rates.py" />
      <source>a thread does not advance along Z</source>
      <translation>una rosca no avanza a lo largo de Z</translation>
    </message>
    <message>
      <location filename="core/motion/feed_rates.py" />
      <source>feed per revolution with the spindle stopped; start it first</source>
      <translation>avance por vuelta con el husillo parado; arránquelo primero</translation>
    </message>
    <message>
      <location filename="core/motion/feed_rates.py" />
      <source>the feed is not above zero; program an F</source>
      <translation>el avance no es mayor que cero; programe una F</translation>
    </message>
    <message>
      <location filename="core/motion/feed_rates.py" />
      <source>the spindle speed on the axis has no upper limit; give G77 or rpm_max</source>
      <translation>la velocidad del husillo sobre el eje no tiene tope; dé G77 o rpm_max</translation>
    </message>
    <message>
      <location filename="core/motion/motion_path.py" />
      <source>Block %1 comes after the end of the path; begin another path.</source>
      <translation>El bloque %1 viene después del final de la trayectoria; empiece otra.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_path.py" />
      <source>Block %1 is not on the planned path.</source>
      <translation>El bloque %1 no está en la trayectoria planeada.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_path.py" />
      <source>Block %1 starts %2 mm from the end of the block before it; plan it from where the machine stands.</source>
      <translation>El bloque %1 empieza a %2 mm del final del anterior; planéelo desde donde está la máquina.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_path.py" />
      <source>There is no block to plan a path of; add the blocks first.</source>
      <translation>No hay bloque de que planear una trayectoria; agregue primero los bloques.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_plan.py" />
      <source>A speed of %1 mm/s at the end of the path cannot come to rest; plan before it.</source>
      <translation>Una velocidad de %1 mm/s al final de la trayectoria no puede parar; planee antes.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_plan.py" />
      <source>A speed of %1 mm/s cannot come to rest within the %2 mm that are left; plan from a state of this path.</source>
      <translation>Una velocidad de %1 mm/s no puede parar en los %2 mm que quedan; planee desde un estado de esta trayectoria.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_plan.py" />
      <source>A speed of %1 mm/s is too high for what follows, which allows %2 mm/s; plan from a state of this path.</source>
      <translation>Una velocidad de %1 mm/s es demasiada para lo que sigue, que permite %2 mm/s; planee desde un estado de esta trayectoria.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_plan.py" />
      <source>Distance %1 is not on the path from %2 to %3 mm.</source>
      <translation>La distancia %1 no está en la trayectoria de %2 a %3 mm.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_plan.py" />
      <source>The %1 override is %2; it must lie between 0 and %3.</source>
      <translation>La perilla %1 está en %2; debe estar entre 0 y %3.</translation>
    </message>
    <message>
      <location filename="core/motion/motion_plan.py" />
      <source>The present speed is %1; it must be zero or above.</source>
      <translation>La velocidad actual es %1; debe ser cero o más.</translation>
    </message>
    <message>
      <location filename="core/motion/path_pieces.py" />
      <source>Block %1: start and end of the arc lie %2 and %3 mm from its centre; correct the centre or the end point.</source>
      <translation>Bloque %1: el principio y el final del arco están a %2 y %3 mm de su centro; corrija el centro o el punto final.</translation>
    </message>
    <message>
      <location filename="core/motion/window_planner.py" />
      <source>A planning window of %1 blocks holds nothing; give at least 1.</source>
      <translation>Una ventana de planeo de %1 bloques no contiene nada; dé al menos 1.</translation>
    </message>
    <message>
      <location filename="core/motion/window_planner.py" />
      <source>A sampling interval of %1 s gives no samples; give a time above zero.</source>
      <translation>Un intervalo de muestreo de %1 s no da muestras; dé un tiempo mayor que cero.</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>%1: %2 nothing as %3; known: %4</source>
      <translation>%1: %2 nada como %3; se conocen: %4</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>%1: character %2 is missing; it is the %3</source>
      <translation>%1: falta el carácter %2; es: %3</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>%1: character %2 is missing; there stands the %3: %4</source>
      <translation>%1: falta el carácter %2; ahí va: %3: %4</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>%1: character %2, %3, is one figure too many</source>
      <translation>%1: el carácter %2, %3, es una cifra de más</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>%1: character 5, %2, means nothing; the size begins there</source>
      <translation>%1: el carácter 5, %2, no significa nada; ahí empieza el tamaño</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>character %1, %2, means</source>
      <translation>el carácter %1, %2, no significa</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>characters %1 and %2, %3, mean</source>
      <translation>los caracteres %1 y %2, %3, no significan</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>corner of a round insert</source>
      <translation>esquina de un inserto redondo</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>corner radius (1/64 in)</source>
      <translation>radio de esquina (1/64 in)</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>corner radius (tenths of a mm)</source>
      <translation>radio de esquina (décimas de mm)</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>size (eighths of an inch)</source>
      <translation>tamaño (octavos de pulgada)</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>size of insert shape %1</source>
      <translation>tamaño de el inserto de forma %1</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>thickness (sixteenths of an inch)</source>
      <translation>espesor (dieciseisavos de pulgada)</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>tolerance class</source>
      <translation>clase de tolerancia</translation>
    </message>
    <message>
      <location filename="core/part/insert_codes.py" />
      <source>type of hole and chip breaker</source>
      <translation>tipo de agujero y rompevirutas</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>an entering angle of %1° leaves a point of %2° no clearance; at most %3°</source>
      <translation>un ángulo de posición de %1° no deja despeje a una punta de %2°; %3° como máximo</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>an outline takes three points that do not lie on one line</source>
      <translation>un contorno necesita tres puntos que no estén en una línea</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>the corner radius is larger than half of the diameter</source>
      <translation>el radio de esquina es mayor que la mitad del diámetro</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>the nose radius is larger than the insert %1</source>
      <translation>el radio de punta es mayor que el inserto %1</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>the pilot is as thick as the centre drill</source>
      <translation>el piloto es tan grueso como la broca de centrar</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>the pitch is too coarse for the diameter of the tap</source>
      <translation>el paso es demasiado grande para el diámetro del macho</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>tip %1 is no end of a round tool: 7 along the spindle, 8 across it, 6 from behind</source>
      <translation>la punta %1 no es extremo de una herramienta redonda: 7 a lo largo del husillo, 8 de través, 6 desde detrás</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>tip %1 is that of a tool in front; behind the spindle the tip lies at %2: %3</source>
      <translation>la punta %1 es la de una herramienta delantera; detrás del husillo la punta está en %2: %3</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>two corners of this nose radius are wider than the edge</source>
      <translation>dos esquinas con este radio son más anchas que el filo</translation>
    </message>
    <message>
      <location filename="core/part/shape_rules.py" />
      <source>what cuts is longer than the tool sticks out</source>
      <translation>lo que corta es más largo que el voladizo de la herramienta</translation>
    </message>
    <message>
      <location filename="core/part/stock_forms.py" />
      <source>bar:D, bar:D:LENGTH, tube:D:BORE, tube:D:BORE:LENGTH, profile:FILE.csv or after:FILE.nc, then +ALLOWANCE</source>
      <translation>bar:D, bar:D:LARGO, tube:D:INTERIOR, tube:D:INTERIOR:LARGO, profile:ARCHIVO.csv o after:ARCHIVO.nc, luego +DEMASÍA</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>%1 has %2 sizes; say one of %3</source>
      <translation>%1 tiene %2 medidas; diga una de %3</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>%1 is no stock; say one of %2</source>
      <translation>%1 no es ningún material; diga una de %2</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>%1 names no file; say %2:FILE</source>
      <translation>%1 no nombra ningún archivo; diga %2:ARCHIVO</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>%1: %2 is no length; say 1.25 (inches) or 30mm</source>
      <translation>%1: %2 no es una longitud; diga 1.25 (pulgadas) o 30mm</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>%1: a diameter is more than 0 and up to %2 in</source>
      <translation>%1: un diámetro es mayor que 0 y hasta %2 in</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>%1: a length is more than 0</source>
      <translation>%1: una longitud es mayor que 0</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>%1: the bore of a tube is more than 0 and less than its diameter</source>
      <translation>%1: el interior de un tubo es mayor que 0 y menor que su diámetro</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>a profile has z, r, or z, r, bore in every row alike</source>
      <translation>un perfil tiene z, r, o z, r, interior, en todas las filas por igual</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>a profile needs two points at least: z, r in each row</source>
      <translation>un perfil necesita al menos dos puntos: z, r en cada fila</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>radii of a profile are not negative, and a bore is within its outside</source>
      <translation>los radios de un perfil no son negativos, y el interior queda dentro del exterior</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>row %1 of the profile has %2 numbers; it has z, r (, bore)</source>
      <translation>la fila %1 del perfil tiene %2 números; lleva z, r (, interior)</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>row %1 of the profile is no numbers: %2</source>
      <translation>la fila %1 del perfil no son números: %2</translation>
    </message>
    <message>
      <location filename="core/part/stock_spec.py" />
      <source>the points of a profile go one way along Z</source>
      <translation>los puntos de un perfil van en un solo sentido a lo largo de Z</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>%1 where there is no metal, from one rapid to the next.</source>
      <translation>%1 donde no hay metal, de un rápido al siguiente.</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>A thread is cut</source>
      <translation>Se corta una rosca</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>A tool is fed</source>
      <translation>Una herramienta avanza</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>This move feeds for %1 s where there is no metal.</source>
      <translation>Este movimiento avanza %1 s donde no hay metal.</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>This move leads away from the part and cuts nothing, and so does the next.</source>
      <translation>Este movimiento se aleja de la pieza y no corta nada, y el siguiente tampoco.</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>This move leads out of the part before its face, inside what the stock measures.</source>
      <translation>Este movimiento sale de la pieza delante de su cara, dentro de lo que mide el material.</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>This move leads out of the part through metal, backwards.</source>
      <translation>Este movimiento sale de la pieza a través del metal, hacia atrás.</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>This move turns a larger diameter than the stock has.</source>
      <translation>Este movimiento tornea un diámetro mayor que el del material.</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>This rapid goes in beside the part, and out again with nothing cut.</source>
      <translation>Este rápido entra junto a la pieza y vuelve a salir sin cortar nada.</translation>
    </message>
    <message>
      <location filename="core/proving/air_checks.py" />
      <source>Up to here tools have fed for %1 s where there is no metal.</source>
      <translation>Hasta aquí las herramientas han avanzado %1 s donde no hay metal.</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>%1, its diameter as %2 in</source>
      <translation>%1, con %2 in de diámetro</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>%1, its width as %2 in</source>
      <translation>%1, con %2 in de ancho</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>, %1 in</source>
      <translation>, %1 in</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>, %1 in wide</source>
      <translation>, %1 in de ancho</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>RIGHT EDGE</source>
      <translation>RIGHT EDGE</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>RIGHT SIDE</source>
      <translation>RIGHT SIDE</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>T%1 is taken for %2 (%3)</source>
      <translation>T%1 se toma por %2 (%3)</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>T%1 is taken for a bar stop</source>
      <translation>T%1 se toma por un tope de barra</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>a boring tool</source>
      <translation>una herramienta de mandrinar</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>a centre drill</source>
      <translation>una broca de centrar</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>a form tool</source>
      <translation>una herramienta de forma</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>a grooving tool</source>
      <translation>una herramienta de ranurar</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>a parting tool</source>
      <translation>una herramienta de tronzar</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>a threading tool</source>
      <translation>una herramienta de roscar</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>a turning tool</source>
      <translation>una herramienta de tornear</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>an end mill</source>
      <translation>una fresa de mango</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>by its comment</source>
      <translation>por su comentario</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>by its moves</source>
      <translation>por sus movimientos</translation>
    </message>
    <message>
      <location filename="core/proving/assumed_tools.py" />
      <source>by its shape</source>
      <translation>por su forma</translation>
    </message>
    <message>
      <location filename="core/proving/block_delete.py" />
      <source>With block delete %1: %2</source>
      <translation>Con salto de bloque %1: %2</translation>
    </message>
    <message>
      <location filename="core/proving/checks_page.py" />
      <source>Found when: %1  </source>
      <translation>Se halla cuando: %1  </translation>
    </message>
    <message>
      <location filename="core/proving/checks_page.py" />
      <source>Rests on: %1.  </source>
      <translation>Se basa en: %1.  </translation>
    </message>
    <message>
      <location filename="core/proving/checks_page.py" />
      <source>what the machine file says</source>
      <translation>lo que dice el archivo de máquina</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>Begin with X and Z under G90.</source>
      <translation>Empiece con X y Z en G90.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>Close the collet with M12 before it.</source>
      <translation>Cierre antes la boquilla con M12.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>Correct the number, or name the input under [io.in] of the machine file.</source>
      <translation>Corrija el número, o nombre la entrada en [io.in] del archivo de máquina.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>Start it with M03 or M04 before it.</source>
      <translation>Arránquelo antes con M03 o M04.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>Switch it on with %1 before it.</source>
      <translation>Enciéndala antes con %1.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>The first move is incremental: it begins where the slides stand, and is proved from home.</source>
      <translation>El primer movimiento es incremental: empieza donde están los carros, y se comprobó desde la referencia.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>The program ends with the collet open, and the next cycle cuts on line %1 before any M12.</source>
      <translation>El programa termina con la boquilla abierta, y el ciclo siguiente corta en la línea %1 antes de un M12.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This machine has no input %1.</source>
      <translation>Esta máquina no tiene la entrada %1.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This machine has no input %1: the wait would never end.</source>
      <translation>Esta máquina no tiene la entrada %1: la espera no acabaría nunca.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This move cuts after %1: its numbers count from the machine's home.</source>
      <translation>Este movimiento corta después de %1: sus números cuentan desde la referencia de la máquina.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This move cuts after the program has stopped the spindle, and no live tool is on.</source>
      <translation>Este movimiento corta después de que el programa paró el husillo, y no hay herramienta motorizada encendida.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This move cuts with no tool: its numbers count from the machine's home.</source>
      <translation>Este movimiento corta sin herramienta: sus números cuentan desde la referencia de la máquina.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This move cuts with the collet open: the part is held by nothing.</source>
      <translation>Este movimiento corta con la boquilla abierta: nada sujeta la pieza.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This move cuts with the spindle held as C, and no live tool is on.</source>
      <translation>Este movimiento corta con el husillo sostenido como C, y no hay herramienta motorizada encendida.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This move feeds with the collet open, and not away from the spindle as a bar is pulled.</source>
      <translation>Este movimiento avanza con la boquilla abierta, y no alejándose del husillo como al jalar la barra.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>This move mills, and no live tool is on.</source>
      <translation>Este movimiento fresa, y no hay herramienta motorizada encendida.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>Write M12 at its end or its start.</source>
      <translation>Escriba M12 a su final o a su inicio.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>Write T with the tool's number before it.</source>
      <translation>Escriba antes T con el número de la herramienta.</translation>
    </message>
    <message>
      <location filename="core/proving/cutting_checks.py" />
      <source>the T0 on line %1</source>
      <translation>el T0 de la línea %1</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>%1, on the side where it does not stand.</source>
      <translation>%1, en el lado donde no está.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 cuts %2 beyond the axis</source>
      <translation>T%1 corta %2 más allá del eje</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 cuts %2 deep with the back of its insert.</source>
      <translation>T%1 corta a %2 de profundidad con la parte trasera de su plaquita.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 cuts %2 deep; its edge reaches %3.</source>
      <translation>T%1 corta %2 de profundidad; su filo llega a %3.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 cuts at Z %2; the part ends at %3.</source>
      <translation>T%1 corta en Z %2; la pieza termina en %3.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 cuts with the spindle turning the other way than where it has cut before.</source>
      <translation>T%1 corta con el husillo girando al revés que donde ha cortado antes.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 feeds %2 with a diameter of %3.</source>
      <translation>T%1 avanza %2 con un diámetro de %3.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 feeds %2 with a nose radius of %3.</source>
      <translation>T%1 avanza %2 con un radio de punta de %3.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 feeds %2 with an edge %3 wide.</source>
      <translation>T%1 avanza %2 con un filo de %3 de ancho.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 goes %2 deep; it cuts %3.</source>
      <translation>T%1 entra %2; corta %3.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1 goes in at %2°, and the back of its insert clears %3°.</source>
      <translation>T%1 entra a %2°, y la parte trasera de su plaquita libra %3°.</translation>
    </message>
    <message>
      <location filename="core/proving/edge_checks.py" />
      <source>T%1, which is %2-hand, cuts while the spindle turns by %3.</source>
      <translation>T%1, que es de mano %2, corta mientras el husillo gira con %3.</translation>
    </message>
    <message>
      <location filename="core/proving/machine_checks.py" />
      <source> (X as a radius)</source>
      <translation> (X como radio)</translation>
    </message>
    <message>
      <location filename="core/proving/machine_checks.py" />
      <source>%1 would go to %2 %3 from home%4, %5 %6 beyond the travel limit of %7</source>
      <translation>%1 iría a %2 %3 de la referencia%4, %5 %6 más allá del límite de carrera de %7</translation>
    </message>
    <message>
      <location filename="core/proving/machine_checks.py" />
      <source>C moves while the spindle turns, and on this machine the spindle itself is C</source>
      <translation>C se mueve mientras gira el husillo, y en esta máquina el husillo mismo es C</translation>
    </message>
    <message>
      <location filename="core/proving/machine_checks.py" />
      <source>check the %1 word and the shifts in force</source>
      <translation>revise la palabra %1 y los desplazamientos vigentes</translation>
    </message>
    <message>
      <location filename="core/proving/machine_checks.py" />
      <source>check the %1 word, the offset of T%2 and any G10 or G92</source>
      <translation>revise la palabra %1, la compensación de T%2 y cualquier G10 o G92</translation>
    </message>
    <message>
      <location filename="core/proving/machine_checks.py" />
      <source>stop it with M5 first, or take a lathe whose C has its own drive: sinumerik-modulo</source>
      <translation>párelo primero con M5, o use un torno cuyo C tenga servo propio: sinumerik-modulo</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A commanded speed over max_rpm under [clamping] of the machine file.</source>
      <translation>Una velocidad mandada por encima de max_rpm en [clamping] del archivo de máquina.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A cut with no tool in force.</source>
      <translation>Un corte sin herramienta activa.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A cut with the collet open.</source>
      <translation>Un corte con la pinza abierta.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A cut with the spindle stopped.</source>
      <translation>Un corte con el husillo parado.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A cutting move leads away from the part, and nothing is cut where the program seems to mean it.</source>
      <translation>Un movimiento de corte se aleja de la pieza y no se corta nada donde el programa parece quererlo.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A drill goes deeper than its flutes are long.</source>
      <translation>Una broca entra más que la longitud de sus canales.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A feed along Z beside the stock, .1 in and longer, stays .08 in and more outside of it.</source>
      <translation>Un avance a lo largo de Z junto al material, de .1 in o más, queda .08 in o más por fuera.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A feed along Z ends more than .5 in, and more than the part is long, behind the deepest part-off.</source>
      <translation>Un avance en Z termina más de .5 in, y más que el largo de la pieza, detrás del tronzado más profundo.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A feed by time after M05, with no live tool on; an error with a feed per turn, G33 or G96.</source>
      <translation>Un avance por tiempo tras M05, sin herramienta motorizada; un error con avance por vuelta, G33 o G96.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A feed goes on where there is no metal.</source>
      <translation>Un avance sigue donde no hay metal.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A feed leads away from the part, or out before its face; feeds between two rapids, or those of a live tool, come near no metal; a rapid goes in and out beside the part with nothing cut; a tool that comes to the part is never fed.</source>
      <translation>Un avance se aleja de la pieza o sale delante de su cara; los avances entre dos rápidos, o los de una herramienta motorizada, no se acercan al metal; un rápido entra y sale junto a la pieza sin cortar nada; una herramienta que llega a la pieza no avanza nunca.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A live tool stands while it mills.</source>
      <translation>Una herramienta motorizada está parada mientras fresa.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A move of plane switching with no live tool on; a warning with the spindle held as C.</source>
      <translation>Un movimiento de cambio de plano sin herramienta motorizada; un aviso con el husillo sujeto como C.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A move that cuts before the first T or after T0; a warning where the program names no tool at all.</source>
      <translation>Un movimiento que corta antes de la primera T o tras T0; un aviso si el programa no nombra ninguna herramienta.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A parting tool stops just before the axis.</source>
      <translation>Una herramienta de tronzar se detiene justo antes del eje.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A rapid right behind a cut takes off metal at a smaller radius than the cut.</source>
      <translation>Un rápido justo después de un corte arranca metal a un radio menor que el corte.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A rapid, or a feed of 100 in/min and more, takes off metal.</source>
      <translation>Un rápido, o un avance de 100 in/min o más, arranca metal.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A tap is drawn out of its thread and not turned out.</source>
      <translation>Un macho se saca de su rosca sin girarlo.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A tap is not fed by its pitch.</source>
      <translation>Un macho no avanza según su paso.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A thread begins before the slide has the speed of its lead, or ends while it brakes.</source>
      <translation>Una rosca empieza antes de que el carro tenga la velocidad de su paso, o termina mientras frena.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A thread does not fit its lead.</source>
      <translation>Una rosca no corresponde a su paso.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A tool, or its holder, runs into chuck, jaws or collet.</source>
      <translation>Una herramienta, o su portaherramientas, choca con el plato, las garras o la pinza.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>A tool, or its holder, runs into the tailstock's centre or quill.</source>
      <translation>Una herramienta, o su portaherramientas, choca con el punto o la caña del contrapunto.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>An insert cuts with its back.</source>
      <translation>Una plaquita corta con su parte trasera.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>An outline comes into the contour of quill and centre that the machine file gives under [clamping].</source>
      <translation>Un contorno entra en el de la caña y el punto que el archivo de máquina da en [clamping].</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>An outline comes into the contour that the machine file gives under [clamping].</source>
      <translation>Un perfil entra en el contorno que el archivo de máquina da en [clamping].</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>An outline that cannot cut overlaps metal by more than .001 in.</source>
      <translation>Un perfil que no puede cortar solapa el metal en más de .001 in.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>An outside tool cuts beyond the axis.</source>
      <translation>Una herramienta exterior corta más allá del eje.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Another tool of the gang plate runs into the stock.</source>
      <translation>Otra herramienta de la placa choca con el material.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>At a feed an outline that cannot cut meets more than .001 in, or a cut is deeper than the edge.</source>
      <translation>En avance, un perfil que no puede cortar encuentra más de .001 in, o un corte es más profundo que el filo.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Behind the face it cuts more than .06 in beyond the axis, where it does not stand.</source>
      <translation>Detrás de la cara corta más de .06 in más allá del eje, donde no está.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Calls by inputs, block delete and loops are followed both ways, as far as the proof goes.</source>
      <translation>Las llamadas por entradas, el salto de bloques y los bucles se siguen de ambas maneras, hasta donde llega la comprobación.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Change M03 and M04, or the hand that the tool's shape says.</source>
      <translation>Cambie M03 y M04, o la mano que dice la forma de la herramienta.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Check K, X of the last pass, the X where it starts, and the pitch of the insert.</source>
      <translation>Revise K, la X de la última pasada, la X donde empieza y el paso de la plaquita.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Check the stock, and X as a radius or a diameter.</source>
      <translation>Compruebe el material, y X como radio o como diámetro.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Close the collet with M12.</source>
      <translation>Cierre la pinza con M12.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Correct the number, or name it under [io.in].</source>
      <translation>Corrija el número o nómbrelo en [io.in].</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Fed backwards over .02 in and two nose radii deep, or into a wall that is steeper than its back.</source>
      <translation>Avance hacia atrás a más de .02 in y dos radios de punta de profundidad, o contra una pared más inclinada que su parte trasera.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>G91 before any move to a place: it begins where the slides stand.</source>
      <translation>G91 antes de cualquier movimiento a un lugar: empieza donde están los carros.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Go on to X0 or a little beyond: look for a lost minus.</source>
      <translation>Siga hasta X0 o un poco más: busque un signo menos perdido.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Go out along X before Z, or in a bore along Z before X.</source>
      <translation>Salga por X antes que por Z; en un agujero, por Z antes que por X.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Holder, shank or boring bar runs into metal at a rapid.</source>
      <translation>El portaherramientas, el mango o la barra de mandrinar choca con el metal en rápido.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>It comes nearer than .04 in to the axis, not to it, and nothing falls off.</source>
      <translation>Se acerca a menos de .04 in del eje, no llega a él, y no cae nada.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>It is deeper than a sharp V of the lead; or the lead is no multiple of the pitch of the insert.</source>
      <translation>Es más profunda que una V aguda de ese paso; o el paso no es múltiplo del de la plaquita.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>It is longer than five times its diameter.</source>
      <translation>Es más larga que cinco veces su diámetro.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>It leaves by a rapid, with the spindle stopped or not reversed, by another feed, or the spindle needs more than .5 in to stand. Not asked of a holder that reverses by itself, as its comment says.</source>
      <translation>Sale en rápido, con el husillo parado o sin invertir, con otro avance, o el husillo necesita más de .5 in para pararse. No se pide a un portamachos que invierte por sí mismo, según su comentario.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Let the part stick out further, or stop earlier.</source>
      <translation>Deje que la pieza sobresalga más, o pare antes.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Lines that no way through the program has reached.</source>
      <translation>Líneas a las que no llega ningún camino del programa.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Look at the call, or prove again with the inputs that lead there.</source>
      <translation>Mire la llamada, o compruebe de nuevo con las entradas que llevan allí.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Look at the sign of X, and for a lost decimal point (X-03 for X-.03).</source>
      <translation>Mire el signo de X y busque un punto decimal perdido (X-03 en vez de X-.03).</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Look for a lost decimal point (Z-3 for Z-.3).</source>
      <translation>Busque un punto decimal perdido (Z-3 en vez de Z-.3).</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Look for a lost minus (Z.5 for Z-.5) or a lost decimal point (X4 for X.4).</source>
      <translation>Busque un signo menos perdido (Z.5 por Z-.5) o un punto decimal perdido (X4 por X.4).</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Look for a lost minus or decimal point; move there by a rapid.</source>
      <translation>Busque un signo menos o un punto decimal perdido; vaya allí en rápido.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Lower F, or look for a lost decimal point (F.03 for F.003).</source>
      <translation>Baje F, o busque un punto decimal perdido (F.03 por F.003).</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Lower S, limit G96 by G77, let the part stick out less, or support it.</source>
      <translation>Baje S, limite G96 con G77, deje que la pieza sobresalga menos o apóyela.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Lower S, or limit G96 by G77.</source>
      <translation>Baje S, o limite G96 con G77.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>M04 with a right-hand drill, reamer or tap, M03 with a left-hand one; or one edge is made to cut both ways.</source>
      <translation>M04 con broca, escariador o macho a derechas, M03 con uno a izquierdas; o un mismo filo tiene que cortar en ambos sentidos.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>M91 to M97 ask for one that the machine file does not name.</source>
      <translation>M91 a M97 piden una que el archivo de máquina no nombra.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Metal is cut behind M13; a warning where a feed does not lead away as a bar is pulled, or the next cycle would begin with an open collet.</source>
      <translation>Se corta metal tras M13; un aviso si un avance no se aleja como al tirar de una barra, o si el siguiente ciclo empezaría con la pinza abierta.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Metal is fed into holder, shank or boring bar.</source>
      <translation>El metal avanza contra el portaherramientas, el mango o la barra de mandrinar.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>More than half of the first critical speed of what sticks out, as a bar of brass held at one end.</source>
      <translation>Más de la mitad de la primera velocidad crítica de lo que sobresale, como barra de latón sujeta por un extremo.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>One stays more than .08 in from all metal for 5 s and .2 in, or several in a row for 20 s.</source>
      <translation>Uno queda a más de .08 in de todo metal durante 5 s y .2 in, o varios seguidos durante 20 s.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Over .8 of the nose radius; .25 of the width of a groover; .1 of the diameter of a drill.</source>
      <translation>Más de .8 del radio de punta; .25 del ancho de una ranuradora; .1 del diámetro de una broca.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Reverse the spindle at the bottom and feed out by the pitch.</source>
      <translation>Invierta el husillo en el fondo y salga avanzando según el paso.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Start farther away, lower S, end in a groove, or pull out with P.</source>
      <translation>Empiece más lejos, baje S, termine en una ranura o salga con P.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Start it with M03 or M04.</source>
      <translation>Arránquelo con M03 o M04.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Stop short of the metal and feed in: look for a G00 left on, and for a sign or a decimal point.</source>
      <translation>Pare antes del metal y entre en avance: busque un G00 que sigue activo, un signo o un punto decimal.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Support it, or part it off in two steps.</source>
      <translation>Sujétela, o trónzela en dos pasos.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Switch it on by the M code that the machine file gives.</source>
      <translation>Conéctela con el código M que da el archivo de máquina.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Take another way there, a shorter tool, or another place on the plate.</source>
      <translation>Vaya por otro camino, con una herramienta más corta, o póngala en otro sitio de la placa.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Take another way there, or a slimmer holder; draw the quill back for what needs the face.</source>
      <translation>Tome otro camino o un portaherramientas más fino; retire la caña para lo que necesita la cara.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The bar is cut far behind where the part is parted off.</source>
      <translation>La barra se corta muy por detrás de donde se tronza la pieza.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The edge meets more than .001 in of metal in r and in Z.</source>
      <translation>El filo encuentra más de .001 in de metal en r y en Z.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The feed of a turn is larger than the edge can cut.</source>
      <translation>El avance por vuelta es mayor de lo que el filo puede cortar.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The feed of a turn is off by more than .08 of the pitch that its shape or its comment gives.</source>
      <translation>El avance por vuelta se aparta más de .08 del paso que da su forma o su comentario.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The first move is incremental.</source>
      <translation>El primer movimiento es incremental.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The hole is deeper than the cutting length of the drill; without a length the proof says so.</source>
      <translation>El agujero es más profundo que el largo de corte de la broca; sin largo, la comprobación lo dice.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The machine has no such input.</source>
      <translation>La máquina no tiene tal entrada.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The metal begins nearer to the start of the pass than v²/2a of the slide; or the pass stops in metal and v²/2a is more than a lead.</source>
      <translation>El metal empieza más cerca del inicio de la pasada que v²/2a del carro; o la pasada se detiene en metal y v²/2a es más que un paso.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The part is larger than its stock: a contour is cut in the air outside the bar.</source>
      <translation>La pieza es mayor que su material: se corta un contorno en el aire, fuera de la barra.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The spindle turns against the cutting edge.</source>
      <translation>El husillo gira contra el filo.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The spindle turns faster than chuck or collet may.</source>
      <translation>El husillo gira más deprisa de lo que permite el plato o la pinza.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The spindle turns so fast that the stock may whirl.</source>
      <translation>El husillo gira tan rápido que el material puede cabecear.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>The tool retracts through the part.</source>
      <translation>La herramienta se retira a través de la pieza.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Use a longer drill, or peck and check the length that was entered.</source>
      <translation>Use una broca más larga, o taladre por picadas y compruebe la longitud introducida.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Use a longer or slimmer tool, or another direction of cut, or less depth.</source>
      <translation>Use una herramienta más larga o más delgada, otra dirección de corte o menos profundidad.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Use a longer or slimmer tool, or another direction of cut.</source>
      <translation>Use una herramienta más larga o más delgada, u otra dirección de corte.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Use a tool of the other hand, a slimmer insert, or cut from the other side.</source>
      <translation>Use una herramienta de la otra mano, una plaquita más fina, o corte desde el otro lado.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>What is parted off is long and held by nothing.</source>
      <translation>Lo que se tronza es largo y nada lo sujeta.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>With [tooling] kind = "gang": its outline, placed by its tool offset, overlaps metal.</source>
      <translation>Con [tooling] kind = "gang": su perfil, situado por su corrector, solapa el metal.</translation>
    </message>
    <message>
      <location filename="core/proving/part_checks.py" />
      <source>Write F as the pitch: 1 divided by the threads per inch.</source>
      <translation>Escriba F como el paso: 1 dividido por los hilos por pulgada.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>%1 deep at Z %2 … %3</source>
      <translation>%1 de profundidad en Z %2 … %3</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>A feed as fast as a rapid goes into metal, %1.</source>
      <translation>Un avance tan rápido como un rápido entra en el metal, %1.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>A feed as fast as a rapid leaves a cut through the part, %1.</source>
      <translation>Un avance tan rápido como un rápido deja un corte a través de la pieza, %1.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>A rapid goes into metal, %1.</source>
      <translation>Un rápido entra en el metal, %1.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>A rapid leaves a cut through the part, %1.</source>
      <translation>Un rápido deja un corte a través de la pieza, %1.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>A rapid of a live tool goes into metal at %1.</source>
      <translation>Un rápido de una herramienta motorizada entra en el metal en %1.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>Silenced: %1</source>
      <translation>Silenciado: %1</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>T%1 beside T%2 on the plate runs into the stock.</source>
      <translation>T%1, junto a T%2 en la placa, choca con el material.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>T%1 goes over the axis, through the part.</source>
      <translation>T%1 pasa sobre el eje, a través de la pieza.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>T%1 parts off down to %2, and nothing falls.</source>
      <translation>T%1 tronza hasta %2, y no cae nada.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>T%1 runs into the chuck, %2.</source>
      <translation>T%1 choca con el plato, %2.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>T%1 runs into the tailstock, %2.</source>
      <translation>T%1 choca con el contrapunto, %2.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>The holder of T%1 runs into metal, %2.</source>
      <translation>El portaherramientas de T%1 choca con el metal, %2.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>The live tool T%1 is fed, and never meets metal.</source>
      <translation>La herramienta motorizada T%1 avanza y nunca toca metal.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>The spindle turns at %1 rpm; the chuck may turn at %2.</source>
      <translation>El husillo gira a %1 rpm; el plato puede girar a %2.</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>The stock sticks out so far that it whirls at %1 rpm; it turns at</source>
      <translation>El material sobresale tanto que cabecea a %1 rpm; gira a</translation>
    </message>
    <message>
      <location filename="core/proving/part_findings.py" />
      <source>What is parted off is %1 times as long as it is thick.</source>
      <translation>Lo que se tronza es %1 veces más largo que grueso.</translation>
    </message>
    <message>
      <location filename="core/proving/part_history.py" />
      <source>%1 blocks: the desk makes the part of up to %2; %3</source>
      <translation>%1 bloques: el puesto hace la pieza de hasta %2; %3</translation>
    </message>
    <message>
      <location filename="core/proving/part_history.py" />
      <source>'turndesk prove --stock' makes that of a longer one</source>
      <translation>'turndesk prove --stock' hace la de uno más largo</translation>
    </message>
    <message>
      <location filename="core/proving/part_proof.py" />
      <source>%1 moves: a part of so many is made where its stock is said</source>
      <translation>%1 movimientos: una pieza de tantos se hace donde se indica su material</translation>
    </message>
    <message>
      <location filename="core/proving/part_proof.py" />
      <source>T%1 is never fed: all its moves are rapids.</source>
      <translation>T%1 no avanza nunca: todos sus movimientos son rápidos.</translation>
    </message>
    <message>
      <location filename="core/proving/part_proof.py" />
      <source>The live tool T%1 is fed, and never comes behind Z0.</source>
      <translation>La herramienta motorizada T%1 avanza y nunca pasa de Z0.</translation>
    </message>
    <message>
      <location filename="core/proving/part_proof.py" />
      <source>This feed leads away from the part, and no other cuts behind Z0.</source>
      <translation>Este avance se aleja de la pieza, y ningún otro corta detrás de Z0.</translation>
    </message>
    <message>
      <location filename="core/proving/part_proof.py" />
      <source>no stock is assumed: no feed cuts behind Z0</source>
      <translation>no se supone material: ningún avance corta detrás de Z0</translation>
    </message>
    <message>
      <location filename="core/proving/part_proof.py" />
      <source>what T%1 cuts from line %2 on while the spindle stands</source>
      <translation>lo que corta T%1 desde la línea %2 con el husillo parado</translation>
    </message>
    <message>
      <location filename="core/proving/program_branches.py" />
      <source>%1 Never proved: %2.</source>
      <translation>%1 Nunca comprobado: %2.</translation>
    </message>
    <message>
      <location filename="core/proving/program_branches.py" />
      <source>%1 ways through the program by its inputs were not proved; %2 were.</source>
      <translation>%1 caminos del programa según sus entradas no se comprobaron; %2 sí.</translation>
    </message>
    <message>
      <location filename="core/proving/program_branches.py" />
      <source>Call it with M98P%1, or take it out.</source>
      <translation>Llámela con M98P%1, o quítela.</translation>
    </message>
    <message>
      <location filename="core/proving/program_branches.py" />
      <source>Fewer conditional calls in loops, or subroutines that end where they begin, make all provable.</source>
      <translation>Con menos llamadas condicionales en lazos, o subrutinas que acaban donde empiezan, todo se puede comprobar.</translation>
    </message>
    <message>
      <location filename="core/proving/program_branches.py" />
      <source>Subroutine %1 is called from nowhere, so it was not proved.</source>
      <translation>Nadie llama a la subrutina %1, así que no se comprobó.</translation>
    </message>
    <message>
      <location filename="core/proving/program_branches.py" />
      <source>With %1 and %2: %3</source>
      <translation>Con %1 y %2: %3</translation>
    </message>
    <message>
      <location filename="core/proving/program_branches.py" />
      <source>With %1: %2</source>
      <translation>Con %1: %2</translation>
    </message>
    <message>
      <location filename="core/proving/program_branches.py" />
      <source>input %1 %2 at line %3</source>
      <translation>la entrada %1 %2 en la línea %3</translation>
    </message>
    <message>
      <location filename="core/proving/program_timeline.py" />
      <source>change the move that the message names</source>
      <translation>cambie el movimiento que nombra el mensaje</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>%1: more than a holder gives.</source>
      <translation>%1: más de lo que cede un portamachos.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>T%1 cuts a pitch of %2; the lead is %3.</source>
      <translation>T%1 corta un paso de %2; el avance de rosca es %3.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>T%1 feeds %2 a turn; its pitch is %3.</source>
      <translation>T%1 avanza %2 por vuelta; su paso es %3.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>T%1 goes in by %2 a turn and out by %3.</source>
      <translation>T%1 entra a %2 por vuelta y sale a %3.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>T%1 goes on for %2 until the spindle stands</source>
      <translation>T%1 sigue %2 hasta que el husillo se para</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>T%1 is drawn out of its thread %2.</source>
      <translation>T%1 se saca de su rosca %2.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>T%1 is drawn out of its thread with the spindle stopped.</source>
      <translation>T%1 se saca de su rosca con el husillo parado.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>T%1 is torn out of its thread by a rapid.</source>
      <translation>T%1 se arranca de su rosca en rápido.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>The metal begins %1 behind the start of the pass; the slide needs %2 to reach the speed of the lead.</source>
      <translation>El metal empieza %1 detrás del inicio de la pasada; el carro necesita %2 para alcanzar la velocidad del paso.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>The slide needs %1 to stop from the speed of the lead, and metal ends %2 before the end of the pass: its last turns have another lead.</source>
      <translation>El carro necesita %1 para pararse desde la velocidad del paso, y el metal termina %2 antes del final de la pasada: sus últimas vueltas tienen otro paso.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>The thread is %1 deep; with a lead of %2 and %3° its flanks meet at %4.</source>
      <translation>La rosca tiene %1 de profundidad; con un paso de %2 y %3° sus flancos se cortan a %4.</translation>
    </message>
    <message>
      <location filename="core/proving/thread_checks.py" />
      <source>while the spindle turns on as it went in</source>
      <translation>mientras el husillo sigue girando como al entrar</translation>
    </message>
    <message>
      <location filename="core/proving/unchecked_parts.py" />
      <source>%1 as neighbours on the plate, without a shape</source>
      <translation>%1 como vecinas en la placa, sin forma</translation>
    </message>
    <message>
      <location filename="core/proving/unchecked_parts.py" />
      <source>chuck, jaws and whirling stock, without a diameter under [clamping] and a stick-out</source>
      <translation>plato, garras y cabeceo del material, sin un diámetro en [clamping] ni un voladizo</translation>
    </message>
    <message>
      <location filename="core/proving/unchecked_parts.py" />
      <source>holder, edge length and hand of %1, which nobody has described</source>
      <translation>portaherramientas, largo de filo y mano de %1, que nadie ha descrito</translation>
    </message>
    <message>
      <location filename="core/proving/unchecked_parts.py" />
      <source>how deep %1 can go, without a flute length</source>
      <translation>hasta dónde puede entrar %1, sin largo de hélice</translation>
    </message>
    <message>
      <location filename="core/proving/unchecked_parts.py" />
      <source>the speed that the chuck may turn at, without max_rpm under [clamping]</source>
      <translation>la velocidad que admite el plato, sin max_rpm en [clamping]</translation>
    </message>
    <message>
      <location filename="core/quality/availability.py" />
      <source>a cycle ends before it begins; the clock was set back</source>
      <translation>un ciclo acaba antes de empezar; el reloj se atrasó</translation>
    </message>
    <message>
      <location filename="core/quality/availability.py" />
      <source>a shift ends after it begins; correct its times</source>
      <translation>un turno acaba después de empezar; corrija sus horas</translation>
    </message>
    <message>
      <location filename="core/quality/capability.py" />
      <source>%1 of %2 readings that a Cpk needs at least</source>
      <translation>%1 de las %2 lecturas que un Cpk necesita al menos</translation>
    </message>
    <message>
      <location filename="core/quality/capability.py" />
      <source>a capability needs a tolerance; enter one for this feature</source>
      <translation>la capacidad necesita una tolerancia; introdúzcala</translation>
    </message>
    <message>
      <location filename="core/quality/capability.py" />
      <source>the lower limit is not below the upper; correct the tolerance</source>
      <translation>el límite inferior no está bajo el superior; corrija la tolerancia</translation>
    </message>
    <message>
      <location filename="core/quality/control_charts.py" />
      <source>a chart of individuals needs 2 values; measure more parts</source>
      <translation>la gráfica de individuales necesita 2 valores; mida más piezas</translation>
    </message>
    <message>
      <location filename="core/quality/control_charts.py" />
      <source>a sample of %1 has no control chart; take 1 to %2 parts</source>
      <translation>una muestra de %1 no tiene gráfica; tome de 1 a %2 piezas</translation>
    </message>
    <message>
      <location filename="core/quality/control_charts.py" />
      <source>a value is no number; take the reading out</source>
      <translation>un valor no es un número; quite la lectura</translation>
    </message>
    <message>
      <location filename="core/quality/control_charts.py" />
      <source>an X-bar chart needs 2 whole samples of %1; measure more parts</source>
      <translation>la gráfica X-barra necesita 2 muestras enteras de %1; mida más piezas</translation>
    </message>
    <message>
      <location filename="core/quality/control_charts.py" />
      <source>samples of an X-bar chart have 2 to 10 values, all the same number</source>
      <translation>las muestras de X-barra tienen de 2 a 10 valores, todas igual</translation>
    </message>
    <message>
      <location filename="core/quality/drift_rules.py" />
      <source>beyond a control limit</source>
      <translation>fuera de un límite de control</translation>
    </message>
    <message>
      <location filename="core/quality/drift_rules.py" />
      <source>eight in a row beyond one sigma</source>
      <translation>ocho seguidas más allá de un sigma</translation>
    </message>
    <message>
      <location filename="core/quality/drift_rules.py" />
      <source>fifteen in a row within one sigma</source>
      <translation>quince seguidas dentro de un sigma</translation>
    </message>
    <message>
      <location filename="core/quality/drift_rules.py" />
      <source>four of five beyond one sigma on one side</source>
      <translation>cuatro de cinco más allá de un sigma a un lado</translation>
    </message>
    <message>
      <location filename="core/quality/drift_rules.py" />
      <source>fourteen in a row going up and down by turns</source>
      <translation>catorce seguidas subiendo y bajando</translation>
    </message>
    <message>
      <location filename="core/quality/drift_rules.py" />
      <source>nine in a row on one side of the centre line</source>
      <translation>nueve seguidas a un lado de la línea central</translation>
    </message>
    <message>
      <location filename="core/quality/drift_rules.py" />
      <source>six in a row rising or falling</source>
      <translation>seis seguidas subiendo o bajando</translation>
    </message>
    <message>
      <location filename="core/quality/drift_rules.py" />
      <source>two of three beyond two sigma on one side</source>
      <translation>dos de tres más allá de dos sigmas a un lado</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>%1: a sample has 1 to %2 parts</source>
      <translation>%1: una muestra tiene de 1 a %2 piezas</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>%1: it grows with its correction or shrinks with it, +1 or -1</source>
      <translation>%1: crece con su corrección o mengua con ella, +1 o -1</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>%1: its lower limit is nothing or less; correct the deviation</source>
      <translation>%1: su límite inferior es cero o menos; corrija la desviación</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>%1: measured every 1 to %2 parts, 0: no plan</source>
      <translation>%1: se mide cada 1 a %2 piezas, 0: sin plan</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>%1: nominal and limits are numbers</source>
      <translation>%1: nominal y límites son números</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>%1: offsets are 1 to %2, not %3</source>
      <translation>%1: las compensaciones son 1 a %2, no %3</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>%1: the lower deviation is not below the upper; correct one of them</source>
      <translation>%1: la desviación inferior no está bajo la superior; corrija una</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>%1: the nominal is more than 0 and at most %2 mm</source>
      <translation>%1: el nominal es mayor que 0 y a lo más %2 mm</translation>
    </message>
    <message>
      <location filename="core/quality/measured_feature.py" />
      <source>a feature has a name of 1 to %1 characters</source>
      <translation>una característica tiene un nombre de 1 a %1 letras</translation>
    </message>
    <message>
      <location filename="core/quality/stops.py" />
      <source>%1: a stop that ends before it begins; the clock was set back</source>
      <translation>%1: un paro que acaba antes de empezar; el reloj se atrasó</translation>
    </message>
    <message>
      <location filename="core/quality/tool_life.py" />
      <source>%1 of %2 min</source>
      <translation>%1 de %2 min</translation>
    </message>
    <message>
      <location filename="core/quality/tool_life.py" />
      <source>%1 of %2 parts</source>
      <translation>%1 de %2 piezas</translation>
    </message>
    <message>
      <location filename="core/quality/tool_life.py" />
      <source>%1 parts, %2 min</source>
      <translation>%1 piezas, %2 min</translation>
    </message>
    <message>
      <location filename="core/quality/tool_life.py" />
      <source>T%1: a life is 0 to %2 cutting minutes, 0: no limit</source>
      <translation>T%1: una vida es de 0 a %2 minutos de corte, 0: sin límite</translation>
    </message>
    <message>
      <location filename="core/quality/tool_life.py" />
      <source>T%1: a life is 0 to %2 parts, 0: no limit</source>
      <translation>T%1: una vida es de 0 a %2 piezas, 0: sin límite</translation>
    </message>
    <message>
      <location filename="core/quality/tool_life.py" />
      <source>T%1: it is warned at 1 to 100 % of the life</source>
      <translation>T%1: se avisa del 1 al 100 % de la vida</translation>
    </message>
    <message>
      <location filename="core/quality/tool_life.py" />
      <source>no limit</source>
      <translation>sin límite</translation>
    </message>
    <message>
      <location filename="core/quality/wear_proposal.py" />
      <source>%1: a correction of %2 mm is no wear; touch the tool off</source>
      <translation>%1: una corrección de %2 mm no es desgaste; toque la herramienta de nuevo</translation>
    </message>
    <message>
      <location filename="core/quality/wear_proposal.py" />
      <source>%1: a reading is more than %2 tolerances off; that is no wear, measure again</source>
      <translation>%1: una lectura está a más de %2 tolerancias; eso no es desgaste, mida de nuevo</translation>
    </message>
    <message>
      <location filename="core/quality/wear_proposal.py" />
      <source>%1: a reading is no number; take it out</source>
      <translation>%1: una lectura no es un número; quítela</translation>
    </message>
    <message>
      <location filename="core/quality/wear_proposal.py" />
      <source>%1: no part was measured since the last correction</source>
      <translation>%1: no se ha medido ninguna pieza desde la última corrección</translation>
    </message>
    <message>
      <location filename="core/quality/wear_proposal.py" />
      <source>less than the smallest step: nothing to correct</source>
      <translation>menos que el paso menor: nada que corregir</translation>
    </message>
    <message>
      <location filename="core/quality/wear_proposal.py" />
      <source>within the dead band: nothing to correct</source>
      <translation>dentro de la banda muerta: nada que corregir</translation>
    </message>
    <message>
      <location filename="core/records/ball_bar.py" />
      <source>a ball-bar plot needs %1 samples of an arc; run it slower or larger</source>
      <translation>un ball bar pide %1 muestras de un arco; hágalo más lento o mayor</translation>
    </message>
    <message>
      <location filename="core/records/ball_bar.py" />
      <source>the arc is shorter than %1 degrees: too short for a ball-bar plot</source>
      <translation>el arco es más corto que %1 grados: demasiado corto para un diagrama ball-bar</translation>
    </message>
    <message>
      <location filename="core/records/ball_bar.py" />
      <source>the driver does not tell where the slides are; there is no arc to see</source>
      <translation>el driver no dice dónde están los carros; no hay arco que ver</translation>
    </message>
    <message>
      <location filename="core/records/ball_bar.py" />
      <source>there is no arc in this time: choose the line of a G02 or G03</source>
      <translation>en este tiempo no hay arco: elija la línea de un G02 o G03</translation>
    </message>
    <message>
      <location filename="core/records/path_error.py" />
      <source>a path error needs %1 samples of a path at least; record while a program runs</source>
      <translation>un error de trayectoria pide al menos %1 muestras; registre mientras corre un programa</translation>
    </message>
    <message>
      <location filename="core/records/path_error.py" />
      <source>nothing moved in this time; record while a program runs</source>
      <translation>nada se movió en este tiempo; registre mientras corre un programa</translation>
    </message>
    <message>
      <location filename="core/records/path_error.py" />
      <source>points and lines of the path do not belong together</source>
      <translation>los puntos y las líneas de la trayectoria no van juntos</translation>
    </message>
    <message>
      <location filename="core/records/path_error.py" />
      <source>the driver does not tell where the slides are; there is no path to compare</source>
      <translation>el driver no dice dónde están los carros; no hay trayectoria que comparar</translation>
    </message>
    <message>
      <location filename="core/records/record_errors.py" />
      <source>%1: the disk is full; make room on it</source>
      <translation>%1: el disco está lleno; haga sitio en él</translation>
    </message>
    <message>
      <location filename="core/records/record_errors.py" />
      <source>%1: there is no such file</source>
      <translation>%1: no existe ese archivo</translation>
    </message>
    <message>
      <location filename="core/records/record_file.py" />
      <source>%1 is cut off; it cannot be read</source>
      <translation>%1 está cortado; no se puede leer</translation>
    </message>
    <message>
      <location filename="core/records/record_file.py" />
      <source>%1 is damaged and cannot be read (%2)</source>
      <translation>%1 está dañado y no se puede leer (%2)</translation>
    </message>
    <message>
      <location filename="core/records/record_file.py" />
      <source>%1 is no record of the scope; name a file that ends in %2</source>
      <translation>%1 no es un registro del osciloscopio; indique un archivo que termine en %2</translation>
    </message>
    <message>
      <location filename="core/records/record_file.py" />
      <source>%1 is no record of the scope; name one of the folder records, %2 or .ring</source>
      <translation>%1 no es un registro del osciloscopio; indique uno de la carpeta records, %2 o .ring</translation>
    </message>
    <message>
      <location filename="core/records/record_file.py" />
      <source>%1 was written by a newer TurnDesk (version %2); open it with that one</source>
      <translation>%1 fue escrito por un TurnDesk más nuevo (versión %2); ábralo con ese</translation>
    </message>
    <message>
      <location filename="core/records/ring_file.py" />
      <source>%1 is being written by another TurnDesk</source>
      <translation>otro TurnDesk está escribiendo %1</translation>
    </message>
    <message>
      <location filename="core/records/ring_file.py" />
      <source>%1 is cut off: %2 of %3 bytes are there; it cannot be read</source>
      <translation>%1 está cortado: hay %2 de %3 bytes; no se puede leer</translation>
    </message>
    <message>
      <location filename="core/records/ring_file.py" />
      <source>%1 is damaged at its beginning; there is nothing to read in it</source>
      <translation>%1 está dañado al principio; no hay nada que leer en él</translation>
    </message>
    <message>
      <location filename="core/records/ring_file.py" />
      <source>%1 is no record of TurnDesk; name a file of the folder records</source>
      <translation>%1 no es un registro de TurnDesk; indique un archivo de la carpeta records</translation>
    </message>
    <message>
      <location filename="core/records/ring_file.py" />
      <source>%1 was written by a newer TurnDesk (version %2); open it with that</source>
      <translation>%1 fue escrito por un TurnDesk más nuevo (versión %2); ábralo con ese</translation>
    </message>
    <message>
      <location filename="core/records/step_response.py" />
      <source>a response needs %1 samples at least; this driver gives too few</source>
      <translation>una respuesta pide al menos %1 muestras; este driver da muy pocas</translation>
    </message>
    <message>
      <location filename="core/records/step_response.py" />
      <source>a step of %1 is no larger than its window of %2: take more</source>
      <translation>un paso de %1 no es mayor que su ventana de %2: tome más</translation>
    </message>
    <message>
      <location filename="core/records/step_response.py" />
      <source>the driver does not tell where the slide is; there is no response to see</source>
      <translation>el driver no dice dónde está el carro; no hay respuesta que ver</translation>
    </message>
    <message>
      <location filename="core/records/step_response.py" />
      <source>the record holds less than one wave of the sine; take more</source>
      <translation>el registro contiene menos de una onda del seno; tome más</translation>
    </message>
    <message>
      <location filename="core/records/step_response.py" />
      <source>the request has no ramp of even speed; take a longer one</source>
      <translation>la consigna no tiene rampa de velocidad constante; tome una más larga</translation>
    </message>
    <message>
      <location filename="core/records/step_response.py" />
      <source>the request has no sine of %1 Hz</source>
      <translation>la consigna no tiene un seno de %1 Hz</translation>
    </message>
    <message>
      <location filename="core/records/thread_passes.py" />
      <source>the passes of a thread need 100 samples at least; record while one is cut</source>
      <translation>las pasadas de una rosca piden al menos 100 muestras; registre mientras se corta</translation>
    </message>
    <message>
      <location filename="core/records/thread_passes.py" />
      <source>the spindle does not turn in this time; record while a thread is cut</source>
      <translation>el husillo no gira en este tiempo; registre mientras se corta una rosca</translation>
    </message>
    <message>
      <location filename="core/records/thread_passes.py" />
      <source>the spindle has no encoder that is counted: its angle is not in the record</source>
      <translation>el husillo no tiene encoder contado: su ángulo no está en el registro</translation>
    </message>
    <message>
      <location filename="core/records/thread_passes.py" />
      <source>there is no pass of a thread in this time: nothing goes two turns evenly</source>
      <translation>en este tiempo no hay pasada de rosca: nada avanza parejo dos vueltas</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>%1 cannot be restored: %2; nothing was changed. Take another backup</source>
      <translation>%1 no se puede restaurar: %2; no se cambió nada. Use otro respaldo</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>%1 cannot be written (%2); check the folder, its space and rights</source>
      <translation>no se puede escribir %1 (%2); revise la carpeta, su espacio y sus permisos</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>%1 is being read by another program; close that one, then restore again</source>
      <translation>otro programa está leyendo %1; ciérrelo y restaure de nuevo</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>%1 is not what was saved</source>
      <translation>%1 no es lo que se guardó</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>%1 is the store itself; name a backup</source>
      <translation>%1 es el almacén mismo; dé un respaldo</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>%1 is the store itself; name another file for the backup</source>
      <translation>%1 es el almacén mismo; dé otro archivo para el respaldo</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>%1: %2; a backup of it would be no use. Restore an older backup</source>
      <translation>%1: %2; un respaldo así no serviría. Restaure un respaldo anterior</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>a row of %1 points to a row of %2 that is not there</source>
      <translation>un renglón de %1 apunta a un renglón de %2 que no está</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>the file is damaged: %1</source>
      <translation>el archivo está dañado: %1</translation>
    </message>
    <message>
      <location filename="core/store/backup.py" />
      <source>there is no store in %1 yet, so there is nothing to back up</source>
      <translation>todavía no hay almacén en %1, así que no hay nada que respaldar</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source> (process %1)</source>
      <translation> (proceso %1)</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source>%1 has gone but its log %2 is still there; put the file back, or move the log away</source>
      <translation>%1 ya no está pero su bitácora %2 sigue ahí; regrese el archivo, o mueva la bitácora</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source>%1 is a database of another program; it is left as it is. Name another file</source>
      <translation>%1 es una base de datos de otro programa; se deja como está. Indique otro archivo</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source>%1 is from an older TurnDesk; start turndesk once to bring it up to date</source>
      <translation>%1 es de un TurnDesk anterior; arranque turndesk una vez para actualizarlo</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source>%1 is not a database; it is left as it is. Restore a backup: turndesk store restore FILE</source>
      <translation>%1 no es una base de datos; se deja como está. Restaure una copia: turndesk store restore ARCHIVO</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source>%1 was written by a newer TurnDesk (store version %2, this one knows %3); it is left as it is. Use the newer TurnDesk</source>
      <translation>%1 fue escrito por un TurnDesk más nuevo (versión de almacén %2, este conoce %3); se deja como está. Use el TurnDesk más nuevo</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source>the folder %1 cannot be made (%2); set TURNDESK_HOME to a folder of yours</source>
      <translation>no se puede crear la carpeta %1 (%2); ponga TURNDESK_HOME en una carpeta suya</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source>the store cannot be brought to version %1, and stays at the one before: %2</source>
      <translation>el almacén no se puede llevar a la versión %1 y se queda en la anterior: %2</translation>
    </message>
    <message>
      <location filename="core/store/database.py" />
      <source>the store in %1 is in use by another TurnDesk%2; close that one, or enter it there</source>
      <translation>otro TurnDesk%2 usa el almacén en %1; ciérrelo, o hágalo allá</translation>
    </message>
    <message>
      <location filename="core/store/event_log.py" />
      <source>the setting %1 cannot be stored: %2</source>
      <translation>el ajuste %1 no se puede guardar: %2</translation>
    </message>
    <message>
      <location filename="core/store/measured_parts.py" />
      <source>%1 has a feature %2 already; give this one another name</source>
      <translation>%1 ya tiene una característica %2; dé otro nombre a esta</translation>
    </message>
    <message>
      <location filename="core/store/measured_parts.py" />
      <source>%1 is not measured any more; enter it anew</source>
      <translation>%1 ya no se mide; introdúzcala de nuevo</translation>
    </message>
    <message>
      <location filename="core/store/measured_parts.py" />
      <source>a reading is a number; measure again</source>
      <translation>una lectura es un número; mida otra vez</translation>
    </message>
    <message>
      <location filename="core/store/measured_parts.py" />
      <source>that reading is taken out already</source>
      <translation>esa lectura ya está quitada</translation>
    </message>
    <message>
      <location filename="core/store/measured_parts.py" />
      <source>the feature of this reading is not measured any more; nothing was kept</source>
      <translation>la característica de esta lectura ya no se mide; no se ha guardado nada</translation>
    </message>
    <message>
      <location filename="core/store/offset_fields.py" />
      <source>%1…%2 in</source>
      <translation>%1…%2 pulg</translation>
    </message>
    <message>
      <location filename="core/store/offset_fields.py" />
      <source>up to %1 characters in one line</source>
      <translation>hasta %1 caracteres en una línea</translation>
    </message>
    <message>
      <location filename="core/store/offset_fields.py" />
      <source>whole number</source>
      <translation>número entero</translation>
    </message>
    <message>
      <location filename="core/store/offset_fields.py" />
      <source>yes or no</source>
      <translation>sí o no</translation>
    </message>
    <message>
      <location filename="core/store/offset_tables.py" />
      <source>%1 is out of range; enter %2</source>
      <translation>%1 está fuera de alcance; escriba %2</translation>
    </message>
    <message>
      <location filename="core/store/offset_tables.py" />
      <source>%1%2 does not exist; offsets are %31…32</source>
      <translation>%1%2 no existe; las compensaciones son %31…32</translation>
    </message>
    <message>
      <location filename="core/store/offset_tables.py" />
      <source>G%1 does not exist; settable offsets are G54…G59</source>
      <translation>G%1 no existe; los ceros ajustables son G54…G59</translation>
    </message>
    <message>
      <location filename="core/store/offset_tables.py" />
      <source>T%1 has no shape yet; enter its kind first: %2</source>
      <translation>T%1 aún no tiene forma; introduzca primero su clase: %2</translation>
    </message>
    <message>
      <location filename="core/store/offset_tables.py" />
      <source>T%1 was never set, so nothing can be relative to it; touch it off first</source>
      <translation>T%1 nunca se puso, nada puede ser relativo a ella; tóquela primero</translation>
    </message>
    <message>
      <location filename="core/store/offset_tables.py" />
      <source>there is no change of G54…G59 to undo</source>
      <translation>no hay cambio de G54…G59 que deshacer</translation>
    </message>
    <message>
      <location filename="core/store/offset_tables.py" />
      <source>there is no change of a tool's shape to undo</source>
      <translation>no hay ningún cambio de forma de herramienta que deshacer</translation>
    </message>
    <message>
      <location filename="core/store/offset_tables.py" />
      <source>there is no offset change to undo</source>
      <translation>no hay cambio de compensación que deshacer</translation>
    </message>
    <message>
      <location filename="core/store/program_records.py" />
      <source> version %1</source>
      <translation> versión %1</translation>
    </message>
    <message>
      <location filename="core/store/program_records.py" />
      <source>%1 cannot name a program; take letters, digits, dot, dash and blank</source>
      <translation>%1 no puede nombrar un programa; use letras, números, punto, guion y espacio</translation>
    </message>
    <message>
      <location filename="core/store/program_records.py" />
      <source>%1 version %2</source>
      <translation>%1 versión %2</translation>
    </message>
    <message>
      <location filename="core/store/program_records.py" />
      <source>%1 version %2 is not what was saved; load another version or a backup</source>
      <translation>%1 versión %2 no es lo que se guardó; cargue otra versión o un respaldo</translation>
    </message>
    <message>
      <location filename="core/store/program_records.py" />
      <source>the store has no program %1%2; see the list of programs and versions</source>
      <translation>el almacén no tiene el programa %1%2; vea la lista de programas y versiones</translation>
    </message>
    <message>
      <location filename="core/store/store.py" />
      <source>%1 is closed; nothing can be read from it any more</source>
      <translation>%1 está cerrado; ya no se puede leer nada de él</translation>
    </message>
    <message>
      <location filename="core/store/store.py" />
      <source>%1 is open for reading only; nothing can be stored</source>
      <translation>%1 está abierto sólo para lectura; no se puede guardar nada</translation>
    </message>
    <message>
      <location filename="core/store/store_errors.py" />
      <source>the disk is full: {path} takes nothing more; make room on that disk</source>
      <translation>el disco está lleno: {path} no admite nada más; haga espacio en ese disco</translation>
    </message>
    <message>
      <location filename="core/store/store_errors.py" />
      <source>{path} cannot be used ({error}); it is left as it is</source>
      <translation>{path} no se puede usar ({error}); se deja como está</translation>
    </message>
    <message>
      <location filename="core/store/store_errors.py" />
      <source>{path} is damaged ({error}); it is left as it is. Restore a backup: turndesk store restore FILE</source>
      <translation>{path} está dañado ({error}); se deja como está. Restaure un respaldo: turndesk store restore FILE</translation>
    </message>
    <message>
      <location filename="core/store/store_errors.py" />
      <source>{path} is locked by another program; close that one, then try again</source>
      <translation>{path} está bloqueado por otro programa; ciérrelo e intente otra vez</translation>
    </message>
    <message>
      <location filename="core/store/store_errors.py" />
      <source>{path} is not there: look at the name, or put it back and start turndesk again</source>
      <translation>{path} no está: revise el nombre, o regréselo y arranque turndesk otra vez</translation>
    </message>
    <message>
      <location filename="core/store/store_errors.py" />
      <source>{path} may not be used so by this user ({error}); check its rights and those of its folder</source>
      <translation>este usuario no puede usar así {path} ({error}); revise sus permisos y los de su carpeta</translation>
    </message>
    <message>
      <location filename="core/store/store_errors.py" />
      <source>{path}: the disk fails ({error}); check that it is there and sound</source>
      <translation>{path}: el disco falla ({error}); revise que esté y que esté sano</translation>
    </message>
    <message>
      <location filename="core/store/store_export.py" />
      <source># Offsets in inches, X a radius.</source>
      <translation># Compensaciones en pulgadas, X es radio.</translation>
    </message>
    <message>
      <location filename="core/store/store_export.py" />
      <source>%1 is no exported folder (%2); name one that 'store export' wrote</source>
      <translation>%1 no es una carpeta exportada (%2); dé una escrita por 'store export'</translation>
    </message>
    <message>
      <location filename="core/store/store_export.py" />
      <source>%1 is not empty; name a new folder for the export</source>
      <translation>%1 no está vacía; dé una carpeta nueva para la exportación</translation>
    </message>
    <message>
      <location filename="core/store/store_export.py" />
      <source>[zero.%1]  # mm and degrees</source>
      <translation>[zero.%1]  # mm and degrees</translation>
    </message>
    <message>
      <location filename="core/store/store_rows.py" />
      <source>behind the spindle</source>
      <translation>detrás del husillo</translation>
    </message>
    <message>
      <location filename="core/store/store_rows.py" />
      <source>cutting length</source>
      <translation>longitud de corte</translation>
    </message>
    <message>
      <location filename="core/store/store_rows.py" />
      <source>entering angle</source>
      <translation>ángulo de posición</translation>
    </message>
    <message>
      <location filename="core/store/store_rows.py" />
      <source>nose radius</source>
      <translation>radio de punta</translation>
    </message>
    <message>
      <location filename="core/store/store_rows.py" />
      <source>point angle</source>
      <translation>ángulo de punta</translation>
    </message>
    <message>
      <location filename="core/store/store_rows.py" />
      <source>tip quadrant</source>
      <translation>cuadrante de punta</translation>
    </message>
    <message>
      <location filename="core/store/store_writer.py" />
      <source>%1 events had no room while nothing could be written</source>
      <translation>%1 eventos no cupieron mientras no se podía escribir</translation>
    </message>
    <message>
      <location filename="core/store/store_writer.py" />
      <source>not kept: %1</source>
      <translation>sin guardar: %1</translation>
    </message>
    <message>
      <location filename="core/store/store_writer.py" />
      <source>nothing was stored (%1)</source>
      <translation>no se guardó nada (%1)</translation>
    </message>
    <message>
      <location filename="core/store/store_writer.py" />
      <source>nothing was stored: %1, then enter it again</source>
      <translation>no se guardó nada: %1, y escríbalo de nuevo</translation>
    </message>
    <message>
      <location filename="core/store/store_writer.py" />
      <source>other entry</source>
      <translation>otro apunte</translation>
    </message>
    <message>
      <location filename="core/store/store_writer.py" />
      <source>the store is closed; nothing can be written any more</source>
      <translation>el almacén está cerrado; ya no se puede escribir nada</translation>
    </message>
    <message>
      <location filename="core/store/tool_lives.py" />
      <source>there is no tool T%1; tools are T%2 to T%3</source>
      <translation>no hay herramienta T%1; las herramientas son T%2 a T%3</translation>
    </message>
    <message>
      <location filename="core/store/touch_off.py" />
      <source>T%1 was never set; touch both X and Z</source>
      <translation>T%1 nunca se puso; toque X y Z</translation>
    </message>
  </context>
</TS>
